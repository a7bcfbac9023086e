#pragma once

#include "transport/transport.h"

namespace wiimote_tracker::transport {

/// Opens a virtual remote that listens at a local socket (AF_UNIX, SOCK_SEQPACKET). One packet is
/// one report; the first packet from the remote is its identity as text. @throws as open().
std::unique_ptr<Transport> openSocket(const std::string& path);

}  // namespace wiimote_tracker::transport
