// The entry point of libFuzzer, compiled once per fuzzer: CAIRN_FUZZ_TARGET names the function of targets.h.

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    cairn::fuzz::CAIRN_FUZZ_TARGET({data, size});
    return 0;
}
