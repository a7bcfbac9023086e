// Builds one target (FUZZ_TARGET) as a program of libFuzzer.
#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  wiimote_tracker::fuzz::FUZZ_TARGET(data, size);
  return 0;
}
