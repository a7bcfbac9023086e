#ifndef WIIMOTE_TRACKER_DRIVER_FUZZ_TARGETS_H
#define WIIMOTE_TRACKER_DRIVER_FUZZ_TARGETS_H

#include <cstddef>
#include <cstdint>

/// What is fuzzed. Each runs one input of any content and size from a clean state.
/// @throws Broken (invariants.h) when a promise is not kept; nothing else gets out.
namespace wiimote_tracker::fuzz {

/// One input report, and with the next 22 bytes a pair of them: all decoders.
void fuzzReports(const std::uint8_t* data, std::size_t size);

/// The factory's blocks in the EEPROM.
void fuzzEeprom(const std::uint8_t* data, std::size_t size);

/// A recording: read, and played to a driver.
void fuzzReplay(const std::uint8_t* data, std::size_t size);

/// wiimote::Session: the input says what comes from the remote, and when.
void fuzzSession(const std::uint8_t* data, std::size_t size);

/// wiimote::Wiimote and a virtual remote: the input says what goes wrong between them.
void fuzzWiimote(const std::uint8_t* data, std::size_t size);

}  // namespace wiimote_tracker::fuzz

#endif  // WIIMOTE_TRACKER_DRIVER_FUZZ_TARGETS_H
