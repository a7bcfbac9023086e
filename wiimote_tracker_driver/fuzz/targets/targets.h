#pragma once

#include <cstddef>
#include <cstdint>

/// Fuzz targets. Each runs one input of any content and size from a clean state. @throws Broken
/// (invariants.h) for a violated invariant; nothing else.
namespace wiimote_tracker::fuzz {

/// One input report, and with the next 22 bytes an interleaved pair: all decoders.
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
