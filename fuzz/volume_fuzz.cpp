#include <array>

#include "base/error.h"
#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "scenes/volume/volume.h"

namespace cairn::fuzz {

void volume(Bytes file) {
    constexpr std::array names = {"volume.mha", "volume.mhd", "volume.nii", "volume.nii.gz"};
    if (file.empty()) return;
    // '0' to '3' in the corpus, so that its files can be read and written by hand.
    const std::string path = scratch_file(names[file[0] % names.size()], file.subspan(1));
    try {
        const scenes::Volume volume = scenes::load_volume(path);
        const auto count =
            std::size_t(volume.size.x) * std::size_t(volume.size.y) * std::size_t(volume.size.z);
        if (volume.samples.size() != count) broken_promise("a volume holds one sample for each cell");
        (void)volume.bounds();
    } catch (const Error& error) {
        if (error.fault() != Fault::input && error.fault() != Fault::memory)
            broken_promise("a damaged volume is Fault::input, one that takes too much Fault::memory");
    }
}

}  // namespace cairn::fuzz
