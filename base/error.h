#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace cairn {

/// Whose fault it is. The command turns it into its exit code (app/terminal/exit_code.h).
enum class Fault {
    usage,        ///< the caller asked for something impossible
    input,        ///< a file is damaged or missing, or needs what is not supported
    context,      ///< no OpenGL 4.5 context, or the driver refused
    memory,       ///< data does not fit in memory or on a disk
    interrupted,  ///< the caller asked to stop
    internal,     ///< a fault of Cairn itself, which should never happen
};

/// The one exception of the libraries: what went wrong, where, and a way out.
///
/// `what()` is one line: "WHERE: WHAT". `way_out()` is a second line, or empty.
///
///     throw Error(Fault::input, "ear.glb: mesh 2 \"ear\", primitive 0",
///                 "accessor 7 ends at byte 90240, its buffer view holds 88064",
///                 "the file is damaged; export it again");
class Error : public std::runtime_error {
public:
    Error(Fault fault, const std::string& where, const std::string& what, std::string way_out = {})
        : std::runtime_error(where.empty() ? what : where + ": " + what),
          fault_(fault),
          way_out_(std::move(way_out)) {}

    [[nodiscard]] Fault fault() const { return fault_; }
    [[nodiscard]] const std::string& way_out() const { return way_out_; }

private:
    Fault fault_;
    std::string way_out_;
};

}  // namespace cairn
