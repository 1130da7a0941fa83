#include "app/terminal/option_names.h"

#include <array>
#include <utility>

namespace cairn::app {
namespace {

/// Names in the error texts of the libraries, each with the option that sets it or the verb that does it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> option_names = {
    {{"ContextOptions::kind", "--context"},
     {"LoadOptions::limits", "--limit"},
     {"LoadOptions::memory_bytes", "--memory"},
     {"LoadOptions::trust_paths", "--trust-paths"},
     {"Method::conservative", "--method conservative"},
     {"PoolSizes::brick_bytes", "--brick-pool"},
     {"create_context()", "cairn render"},
     {"grid_over()", "--bounds"}}};

}  // namespace

std::string with_option_names(std::string_view text) {
    std::string out(text);
    for (const auto& [name, option] : option_names) {
        for (std::size_t at = out.find(name); at != std::string::npos;
             at = out.find(name, at + option.size()))
            out.replace(at, name.size(), option);
    }
    return out;
}

}  // namespace cairn::app
