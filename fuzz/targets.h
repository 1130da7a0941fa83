#pragma once

#include <cstdint>
#include <span>

/// Entry points for fuzzers. Each takes any bytes, and returns once Cairn has either accepted them or refused
/// them with the error that its header promises. Any other result ends the program: a crash, a sanitizer's
/// report, an exception of another kind, or broken_promise().
///
/// A libFuzzer program calls one entry point (libfuzzer.cpp); tests/fuzz runs all of them over corpus/.
namespace cairn::fuzz {

using Bytes = std::span<const std::uint8_t>;

void gltf(Bytes file);      ///< a .gltf or .glb, loaded and played
void volume(Bytes file);    ///< first byte: the format; then a .mha, .mhd, .nii or .nii.gz
void uri(Bytes text);       ///< a URI of a glTF file, resolved and decoded
void options(Bytes lines);  ///< a command line, one argument per line, parsed and not run
void transfer(Bytes text);  ///< the text of a transfer function

/// Ends the program, because an entry point met a result that a header excludes.
[[noreturn]] void broken_promise(const char* what);

}  // namespace cairn::fuzz
