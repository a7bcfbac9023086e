#include "sdp.h"

#include "virtual_wiimote/report_descriptor.h"

#include <algorithm>
#include <map>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr unsigned kHidService = 0x1124;
constexpr unsigned kPnpService = 0x1200;
constexpr unsigned kBrowseGroup = 0x1002;
constexpr unsigned kL2cap = 0x0100;
constexpr unsigned kHidp = 0x0011;
constexpr unsigned kNintendo = 0x057e;
constexpr std::size_t kLongestPart = 400;

// Data elements: a byte with type and size, then the value.
Bytes number8(unsigned value) {
  return {0x08, static_cast<std::uint8_t>(value)};
}
Bytes number(unsigned value) {
  return join(Bytes{0x09}, be16(value));
}
Bytes uuid(unsigned value) {
  return join(Bytes{0x19}, be16(value));
}
Bytes yes(bool value) {
  return {0x28, value};
}
Bytes text(const std::string& value) {
  return join(Bytes{0x25, static_cast<std::uint8_t>(value.size())}, value);
}
template <typename... Elements>
Bytes sequence(const Elements&... elements) {
  const Bytes all = join(elements...);
  const auto size = static_cast<unsigned>(all.size());
  return join(
      size < 256 ? Bytes{0x35, static_cast<std::uint8_t>(size)} : join(Bytes{0x36}, be16(size)),
      all);
}

/// Attributes of a service by their ids.
using Record = std::map<unsigned, Bytes>;

Record hidRecord(const std::string& name) {
  const auto& raw = virtual_wiimote::kReportDescriptor;
  const std::string descriptor(raw.begin(), raw.end());
  return {
      {0x000, join(Bytes{0x0a}, be16(1), be16(0))},  // record handle
      {0x001, sequence(uuid(kHidService))},
      {0x004, sequence(sequence(uuid(kL2cap), number(0x11)), sequence(uuid(kHidp)))},
      {0x005, sequence(uuid(kBrowseGroup))},
      {0x006, sequence(number(0x656e), number(0x6a), number(0x100))},
      {0x009, sequence(sequence(uuid(kHidService), number(0x100)))},
      {0x00d, sequence(sequence(sequence(uuid(kL2cap), number(0x13)), sequence(uuid(kHidp))))},
      {0x100, text(name)},
      {0x101, text(name)},
      {0x102, text("Nintendo")},
      {0x200, number(0x100)},
      {0x201, number(0x111)},
      {0x202, number8(4)},
      {0x203, number8(0x33)},
      {0x204, yes(false)},
      {0x205, yes(true)},
      {0x206, sequence(sequence(number8(0x22), text(descriptor)))},
      {0x207, sequence(sequence(number(0x409), number(0x100)))},
      {0x208, yes(false)},
      {0x209, yes(true)},
      {0x20a, yes(true)},
      {0x20b, number(0x100)},
      {0x20c, number(0xc80)},
      {0x20d, yes(false)},
      {0x20e, yes(false)},
  };
}

Record pnpRecord(unsigned product) {
  return {
      {0x000, join(Bytes{0x0a}, be16(1), be16(1))},  // record handle
      {0x001, sequence(uuid(kPnpService))},
      {0x004, sequence(sequence(uuid(kL2cap), number(1)), sequence(uuid(1)))},
      {0x005, sequence(uuid(kBrowseGroup))},
      {0x009, sequence(sequence(uuid(kPnpService), number(0x100)))},
      {0x200, number(0x100)},
      {0x201, number(kNintendo)},
      {0x202, number(product)},
      {0x203, number(0x600)},
      {0x204, yes(true)},
      {0x205, number(2)},
  };
}

/// Reads the data element at `offset`, which moves behind it. @returns its value.
Bytes readElement(const Bytes& bytes, std::size_t& offset) {
  const unsigned size_code = bytes.at(offset++) & 7u;
  std::size_t size = std::size_t{1} << size_code;
  if (size_code == 5) {
    size = bytes.at(offset++);
  } else if (size_code == 6) {
    size = be16At(bytes, offset);
    offset += 2;
  }
  const Bytes value = part(bytes, offset, size);
  offset += size;
  return value;
}

/// A UUID of 2, 4 or 16 bytes in its short form.
unsigned shortUuid(const Bytes& value) {
  return be16At(value, value.size() == 2 ? 0 : 2);
}

bool hasAll(const Record& record, const Bytes& pattern) {
  for (std::size_t offset = 0; offset < pattern.size();) {
    const Bytes wanted = uuid(shortUuid(readElement(pattern, offset)));
    if (std::none_of(record.begin(), record.end(), [&](const auto& attribute) {
          const Bytes& value = attribute.second;
          return std::search(value.begin(), value.end(), wanted.begin(), wanted.end()) !=
                 value.end();
        }))
      return false;
  }
  return true;
}

/// The attributes with the ids of this list, which are single or ranges.
Bytes attributesOf(const Record& record, const Bytes& ids) {
  Bytes found;
  for (std::size_t offset = 0; offset < ids.size();) {
    const Bytes id = readElement(ids, offset);
    const unsigned last = be16At(id, id.size() - 2);
    for (auto i = record.lower_bound(be16At(id, 0)); i != record.end() && i->first <= last; ++i)
      found = join(found, number(i->first), i->second);
  }
  return sequence(found);
}

Bytes packet(std::uint8_t id, const Bytes& request, const Bytes& content) {
  return join(Bytes{id}, part(request, 1, 2), be16(static_cast<unsigned>(content.size())), content);
}

}  // namespace

Bytes answerSdp(const Bytes& request, const std::string& name, unsigned product) {
  constexpr std::uint8_t kSearchAttributeRequest = 6;
  if (request.at(0) != kSearchAttributeRequest)
    return packet(1, request, be16(3));  // error: invalid syntax
  std::size_t offset = 5;
  const Bytes pattern = readElement(request, offset);
  const std::size_t longest = std::min<std::size_t>(be16At(request, offset), kLongestPart);
  offset += 2;
  const Bytes ids = readElement(request, offset);
  // The continuation state is the offset of the next part.
  const std::size_t begin = request.at(offset) == 2 ? be16At(request, offset + 1) : 0;

  Bytes found;
  for (const Record& record : {pnpRecord(product), hidRecord(name)}) {
    if (hasAll(record, pattern))
      found = join(found, attributesOf(record, ids));
  }
  const Bytes all = sequence(found);
  const Bytes answer = part(all, begin, longest);
  const std::size_t end = begin + answer.size();
  const Bytes more = end < all.size() ? join(Bytes{2}, be16(static_cast<unsigned>(end))) : Bytes{0};
  return packet(7, request, join(be16(static_cast<unsigned>(answer.size())), answer, more));
}

}  // namespace wiimote_tracker::real_kernel
