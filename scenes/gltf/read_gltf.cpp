#include "scenes/gltf/read_gltf.h"

#include <exception>
#include <new>
#include <utility>

#include "base/error.h"
#include "scenes/gltf/failure.h"
#include "scenes/gltf/reader.h"

namespace cairn::scenes::gltf {
namespace {

Scene convert(const std::filesystem::path& path, const LoadOptions& options) {
    Reader reader(read_source(path, options), options);
    check_extensions(reader);
    read_materials(reader);
    read_meshes(reader);
    read_nodes(reader);
    check_forest(reader);
    read_skins(reader);
    read_animations(reader);
    reader.scene.placing = reader.placing_limits();
    return std::move(reader.scene);
}

}  // namespace

Scene read_gltf(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string name = path.filename().string();
    try {
        return convert(path, options);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, name, "it needs more memory than there is",
                    "use a machine with more, or split the scene");
    } catch (const std::exception& error) {
        fail(name, std::string("a library gave up on it: ") + error.what());
    }
}

}  // namespace cairn::scenes::gltf
