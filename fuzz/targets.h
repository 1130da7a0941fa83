#pragma once

#include <cstdint>
#include <span>

/// What fuzzers feed: each entry point takes any bytes, and returns when Cairn has either understood them or
/// refused them with the error that its header promises. Anything else ends the program: a crash, a
/// sanitizer's report, an exception of another kind, or broken_promise().
///
/// libFuzzer calls one of them per program (libfuzzer.cpp); tests/fuzz runs all of them over corpus/.
namespace cairn::fuzz {

using Bytes = std::span<const std::uint8_t>;

void gltf(Bytes file);      ///< a .gltf or .glb, loaded and played
void volume(Bytes file);    ///< first byte: the format; then a .mha, .mhd, .nii or .nii.gz
void uri(Bytes text);       ///< a URI of a glTF file, resolved and decoded
void options(Bytes lines);  ///< a command line, one argument per line, parsed and not run
void transfer(Bytes text);  ///< the text of a transfer function

/// Ends the program: an entry point saw something that a header excludes.
[[noreturn]] void broken_promise(const char* what);

}  // namespace cairn::fuzz
