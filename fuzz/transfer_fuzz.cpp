#include <string>

#include "app/options/transfer_option.h"
#include "base/error.h"
#include "fuzz/targets.h"

namespace cairn::fuzz {

void transfer(Bytes text) {
    try {
        const app::TransferChoice choice = app::parse_transfer(std::string(text.begin(), text.end()));
        if (choice.points.empty()) broken_promise("a transfer function has points");
        (void)choice.for_voxels(1.0);
    } catch (const Error& error) {
        if (error.fault() != Fault::usage) broken_promise("a wrong transfer function is Fault::usage");
    }
}

}  // namespace cairn::fuzz
