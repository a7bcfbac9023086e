#include "bag_file.h"

#include "error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace wiimote_tracker {
namespace {

constexpr std::size_t kChunkSize = 768 * 1024;  // a chunk ends when it is larger [bytes]
constexpr std::size_t kHeaderSize = 4096;       // of the file's, padded, since it grows [bytes]

using Bytes = std::vector<std::uint8_t>;

enum Record : std::uint8_t {
  kMessage = 2,
  kFileHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

void put(const std::string& text, Bytes* bytes) {
  bytes->insert(bytes->end(), text.begin(), text.end());
}

/// Least significant byte first, as all numbers in a bag.
template <typename Number>
void put(Number number, Bytes* bytes) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes->push_back(static_cast<std::uint8_t>(number >> 8 * i));
}

void put(const ros::Time& time, Bytes* bytes) {
  put(time.sec, bytes);
  put(time.nsec, bytes);
}

std::uint32_t sizeOf(const ros::Time&) {
  return 8;
}

std::uint32_t sizeOf(const std::string& text) {
  return static_cast<std::uint32_t>(text.size());
}

template <typename Number>
std::uint32_t sizeOf(Number) {
  return sizeof(Number);
}

template <typename Value>
void putField(const std::string& name, const Value& value, Bytes* bytes) {
  put(static_cast<std::uint32_t>(name.size() + 1 + sizeOf(value)), bytes);
  put(name, bytes);
  put(std::string("="), bytes);
  put(value, bytes);
}

/// A length that is known when what follows is there.
class Length {
 public:
  explicit Length(Bytes* bytes) : bytes_(bytes), place_(bytes->size()) {
    put(std::uint32_t{0}, bytes);
  }

  void isHere() const {
    Bytes length;
    put(static_cast<std::uint32_t>(bytes_->size() - place_ - sizeof(std::uint32_t)), &length);
    std::copy(length.begin(), length.end(), bytes_->begin() + static_cast<std::ptrdiff_t>(place_));
  }

 private:
  Bytes* bytes_;
  std::size_t place_;
};

}  // namespace

BagFile::BagFile(const std::string& path) : file_(std::fopen(path.c_str(), "wb")) {
  if (!file_)
    throw BagError(std::strerror(errno));
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);  // what is written is large
  Bytes magic;
  put(std::string("#ROSBAG V2.0\n"), &magic);
  write(magic);
  writeHeader(0);
}

std::uint32_t BagFile::addConnection(const std::string& topic, const ros::M_string& header) {
  const auto number = static_cast<std::uint32_t>(connections_.size());
  Bytes record;
  const Length header_length(&record);
  putField("conn", number, &record);
  putField("op", std::uint8_t{kConnection}, &record);
  putField("topic", topic, &record);
  header_length.isHere();
  const Length data_length(&record);
  for (const auto& [name, value] : header)
    putField(name, value, &record);
  data_length.isHere();
  chunk_.insert(chunk_.end(), record.begin(), record.end());
  connections_.push_back(std::move(record));
  return number;
}

std::uint8_t* BagFile::add(std::uint32_t connection, const ros::Time& time, std::uint32_t size) {
  if (chunk_.size() > kChunkSize)
    finishChunk();
  index_[connection].push_back({time, static_cast<std::uint32_t>(chunk_.size())});
  const Length header_length(&chunk_);
  putField("conn", connection, &chunk_);
  putField("op", std::uint8_t{kMessage}, &chunk_);
  putField("time", time, &chunk_);
  header_length.isHere();
  put(size, &chunk_);
  chunk_.resize(chunk_.size() + size);
  return chunk_.data() + (chunk_.size() - size);
}

void BagFile::finishChunk() {
  if (chunk_.empty())
    return;
  ChunkInfo info;
  info.position = position_;
  info.start = ros::TIME_MAX;
  Bytes head;
  const Length header_length(&head);
  putField("compression", std::string("none"), &head);
  putField("op", std::uint8_t{kChunk}, &head);
  putField("size", static_cast<std::uint32_t>(chunk_.size()), &head);
  header_length.isHere();
  put(static_cast<std::uint32_t>(chunk_.size()), &head);
  write(head);
  write(chunk_);

  Bytes records;
  for (auto& [connection, entries] : index_) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const IndexEntry& a, const IndexEntry& b) { return a.time < b.time; });
    const auto count = static_cast<std::uint32_t>(entries.size());
    info.start = std::min(info.start, entries.front().time);
    info.end = std::max(info.end, entries.back().time);
    info.counts[connection] = count;
    const Length index_length(&records);
    putField("conn", connection, &records);
    putField("count", count, &records);
    putField("op", std::uint8_t{kIndex}, &records);
    putField("ver", std::uint32_t{1}, &records);
    index_length.isHere();
    const Length data_length(&records);
    for (const IndexEntry& entry : entries) {
      put(entry.time, &records);
      put(entry.offset, &records);
    }
    data_length.isHere();
  }
  write(records);
  chunks_.push_back(std::move(info));
  chunk_.clear();
  index_.clear();
}

void BagFile::finish() {
  finishChunk();
  const std::uint64_t index_position = position_;
  Bytes records;
  for (const Bytes& connection : connections_)
    records.insert(records.end(), connection.begin(), connection.end());
  for (const ChunkInfo& chunk : chunks_) {
    const Length header_length(&records);
    putField("chunk_pos", chunk.position, &records);
    putField("count", static_cast<std::uint32_t>(chunk.counts.size()), &records);
    putField("end_time", chunk.end, &records);
    putField("op", std::uint8_t{kChunkInfo}, &records);
    putField("start_time", chunk.start, &records);
    putField("ver", std::uint32_t{1}, &records);
    header_length.isHere();
    const Length data_length(&records);
    for (const auto& [connection, count] : chunk.counts) {
      put(connection, &records);
      put(count, &records);
    }
    data_length.isHere();
  }
  write(records);
  writeHeader(index_position);
  if (std::fclose(file_.release()) != 0)
    throw BagError(std::strerror(errno));
}

/// Behind the first line of the file. @param index_position 0: not known yet.
void BagFile::writeHeader(std::uint64_t index_position) {
  constexpr long kPlace = 13;  // of the first line's end
  if (std::fseek(file_.get(), kPlace, SEEK_SET) != 0)
    throw BagError(std::strerror(errno));
  Bytes record;
  const Length header_length(&record);
  putField("chunk_count", static_cast<std::uint32_t>(chunks_.size()), &record);
  putField("conn_count", static_cast<std::uint32_t>(connections_.size()), &record);
  putField("index_pos", index_position, &record);
  putField("op", std::uint8_t{kFileHeader}, &record);
  header_length.isHere();
  const Length data_length(&record);
  record.resize(kHeaderSize + 2 * sizeof(std::uint32_t), ' ');
  data_length.isHere();
  write(record);
}

void BagFile::write(const Bytes& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    throw BagError(std::strerror(errno));
  position_ += bytes.size();
}

}  // namespace wiimote_tracker
