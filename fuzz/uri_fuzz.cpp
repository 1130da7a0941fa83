#include <filesystem>
#include <string>

#include "base/error.h"
#include "fuzz/targets.h"
#include "scenes/gltf/uri.h"

namespace cairn::fuzz {
namespace {

void resolve(const std::string& uri, bool trust_paths) {
    const std::filesystem::path folder = "/models/scene";
    try {
        const std::filesystem::path path = scenes::gltf::resolve_uri("uri", uri, folder, trust_paths);
        if (trust_paths) return;
        const std::filesystem::path way = path.lexically_normal().lexically_relative(folder);
        if (way.empty() || way.is_absolute() || *way.begin() == "..")
            broken_promise("a URI that is not trusted stays in the scene's folder");
    } catch (const Error& error) {
        if (error.fault() != Fault::input) broken_promise("a bad URI is Fault::input");
    }
}

}  // namespace

void uri(Bytes text) {
    const std::string uri(text.begin(), text.end());
    try {
        if (scenes::gltf::is_data_uri(uri)) (void)scenes::gltf::decode_data_uri("uri", uri);
    } catch (const Error& error) {
        if (error.fault() != Fault::input) broken_promise("a bad data URI is Fault::input");
    }
    resolve(uri, false);
    resolve(uri, true);
}

}  // namespace cairn::fuzz
