#include "app/variants/variant_store.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "app/base/checksum.hpp"
#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

namespace {

constexpr char kMagic[9] = "drevVAR2";
constexpr std::uint64_t kPage = 4096;

/// Head at the start of the file; the description follows it.
struct Head {
  char magic[8];
  std::uint64_t text, checksum;  // bytes of the description, and its checksum
  std::uint64_t blocks, numbers;
};

/// End of a place, after the numbers of the rows.
struct Tail {
  std::uint64_t at, size;  // position and length of the reasons of the block [bytes]
  std::uint64_t checksum;
};

std::size_t place_size_of(std::uint64_t numbers) { return numbers * sizeof(double) + sizeof(Tail); }

std::uint64_t up_to_page(std::uint64_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

/// Reads `size` bytes. Returns the number of bytes read, fewer at the file's end; -1: an error.
ssize_t read_all(int descriptor, char* to, std::size_t size, std::uint64_t at) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::pread(descriptor, to + done, size - done, static_cast<off_t>(at + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return -1;
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(done);
}

[[noreturn]] void fail(const std::string& path, int error, const std::string& more = {}) {
  throw OutputError("cannot write " + path + ": " + std::strerror(error) + more);
}

void write_all(int descriptor, const std::string& path, const std::string& bytes, std::uint64_t at) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count =
        ::pwrite(descriptor, bytes.data() + done, bytes.size() - done, static_cast<off_t>(at + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    done += static_cast<std::size_t>(count);
  }
}

/// Reads head and description of a store; false: they are missing or incomplete.
bool read_head(int descriptor, Head& head, std::string& text) {
  if (read_all(descriptor, reinterpret_cast<char*>(&head), sizeof head, 0) != sizeof head) return false;
  if (std::memcmp(head.magic, kMagic, sizeof head.magic) != 0 || head.text > (std::uint64_t{1} << 28))
    return false;
  text.resize(head.text);
  return read_all(descriptor, text.data(), text.size(), sizeof head) == static_cast<ssize_t>(text.size()) &&
         checksum(text) == head.checksum;
}

void append(std::string& bytes, const void* from, std::size_t size) {
  bytes.append(static_cast<const char*>(from), size);
}

/// Checksum of a place without its own, and of the reasons; never 0, which an unwritten place contains.
std::uint64_t place_checksum(std::string_view bytes, std::string_view reasons, std::uint64_t block,
                             std::uint64_t key) {
  std::string numbers;
  append(numbers, &block, sizeof block);
  append(numbers, &key, sizeof key);
  return checksum(reasons, checksum(bytes, checksum(numbers))) | 1U;
}

class Reader {
 public:
  explicit Reader(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)) {}
  ~Reader() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  operator int() const { return descriptor_; }  // NOLINT: as system calls take it

 private:
  int descriptor_;
};

std::string megabytes(std::uint64_t bytes) {
  return short_digits(std::max(0.1, static_cast<double>(bytes) / 1e6), 3) + " MB";
}

}  // namespace

const std::string& BlockRows::reason(std::size_t row) const {
  static const std::string kNoReason;
  return row < reasons.size() ? reasons[row] : kNoReason;
}

void BlockRows::set_reason(std::size_t row, const std::string& reason) {
  if (reasons.size() <= row) reasons.resize(row + 1);
  std::size_t size = std::min(kReason, reason.size());
  // A character of several bytes of UTF-8 is left out as a whole.
  while (size > 0 && size < reason.size() && (static_cast<unsigned char>(reason[size]) & 0xC0U) == 0x80U)
    --size;
  reasons[row] = reason.substr(0, size);
}

std::string reasons_as_bytes(const std::vector<std::string>& reasons) {
  std::string bytes;
  for (const std::string& reason : reasons) append(bytes, reason.c_str(), reason.size() + 1);
  return bytes;
}

std::vector<std::string> reasons_in(const std::string& bytes) {
  std::vector<std::string> reasons = split(bytes, '\0');
  reasons.pop_back();  // behind the last zero there is nothing
  return reasons;
}

std::string VariantStore::path_in(const std::string& folder) { return folder + "/variants.partial.store"; }

std::optional<std::string> VariantStore::description_in(const std::string& folder) {
  const Reader file(path_in(folder));
  Head head{};
  std::string text;
  if (file < 0 || !read_head(file, head, text)) return {};
  return text;
}

std::pair<std::uint64_t, std::uint64_t> VariantStore::progress_in(const std::string& folder) {
  const Reader file(path_in(folder));
  Head head{};
  std::string text;
  if (file < 0 || !read_head(file, head, text)) return {};
  const std::size_t size = place_size_of(head.numbers);
  std::string bytes(size, '\0');
  std::uint64_t done = 0;
  for (std::uint64_t block = 0; block < head.blocks; ++block) {
    const std::uint64_t at = up_to_page(sizeof head + head.text) + block * size;
    if (read_all(file, bytes.data(), size, at) != static_cast<ssize_t>(size)) break;
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + size - sizeof sum, sizeof sum);
    if (sum != 0) ++done;
  }
  return {done, head.blocks};
}

VariantStore::VariantStore(const std::string& folder, const std::string& description, StoreShape shape,
                           bool resume)
    : path_(path_in(folder)), shape_(shape), key_(checksum(description)), done_(shape.blocks, false) {
  create_directory(folder);
  descriptor_ = open_to_write(path_, O_CREAT, O_RDWR);
  try {
    Head head{{}, description.size(), key_, shape.blocks, shape.numbers};
    std::memcpy(head.magic, kMagic, sizeof head.magic);
    start_ = up_to_page(sizeof head + description.size());
    end_ = place(shape.blocks);
    Head found{};
    std::string text;
    if (resume && read_head(descriptor_, found, text) && text == description &&
        std::memcmp(&found, &head, sizeof head) == 0) {
      std::string bytes, reasons;
      for (std::uint64_t block = 0; block < shape.blocks; ++block) {
        if (!read(block, bytes, reasons)) continue;
        done_[block] = true, ++count_;
        Tail tail{};
        std::memcpy(&tail, bytes.data() + bytes.size() - sizeof tail, sizeof tail);
        end_ = std::max(end_, tail.at + tail.size);
      }
    } else {
      if (::ftruncate(descriptor_, 0) != 0) fail(path_, errno);
      std::string bytes;
      append(bytes, &head, sizeof head);
      write_all(descriptor_, path_, bytes + description, 0);
    }
    const std::uint64_t size = place(shape.blocks);
    // Not posix_fallocate(), which writes all of the file if the file system does not support it.
    if (::fallocate(descriptor_, 0, 0, static_cast<off_t>(size)) != 0 &&
        (errno != EOPNOTSUPP || ::ftruncate(descriptor_, static_cast<off_t>(size)) != 0)) {
      const int error = errno;
      if (count_ == 0) std::remove(path_.c_str());
      fail(path_, error,
           "; the study's rows take " + megabytes(size) + " there, and their table as much again");
    }
    sync();
    sync_directory(folder);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

VariantStore::~VariantStore() { ::close(descriptor_); }

std::size_t VariantStore::place_size() const { return place_size_of(shape_.numbers); }

std::uint64_t VariantStore::place(std::uint64_t block) const { return start_ + block * place_size(); }

bool VariantStore::read(std::uint64_t block, std::string& bytes, std::string& reasons) const {
  bytes.resize(place_size());
  if (read_all(descriptor_, bytes.data(), bytes.size(), place(block)) != static_cast<ssize_t>(bytes.size()))
    return false;
  Tail tail{};
  std::memcpy(&tail, bytes.data() + bytes.size() - sizeof tail, sizeof tail);
  // A block has no more rows than numbers; a torn place may state any length.
  if (tail.checksum == 0 || tail.size > shape_.numbers * (BlockRows::kReason + 1)) return false;
  reasons.resize(tail.size);
  if (read_all(descriptor_, reasons.data(), reasons.size(), tail.at) != static_cast<ssize_t>(reasons.size()))
    return false;
  const std::string_view summed(bytes.data(), bytes.size() - sizeof tail.checksum);
  return tail.checksum == place_checksum(summed, reasons, block, key_);
}

void VariantStore::put(std::uint64_t block, const BlockRows& rows) {
  const std::string reasons = reasons_as_bytes(rows.reasons);
  Tail tail{.at = end_, .size = reasons.size(), .checksum = 0};
  write_all(descriptor_, path_, reasons, tail.at);
  end_ += tail.size;
  std::string bytes;
  append(bytes, rows.numbers.data(), rows.numbers.size() * sizeof(double));
  append(bytes, &tail, sizeof tail - sizeof tail.checksum);
  tail.checksum = place_checksum(bytes, reasons, block, key_);
  append(bytes, &tail.checksum, sizeof tail.checksum);
  write_all(descriptor_, path_, bytes, place(block));
  if (!done_[block]) ++count_;
  done_[block] = true;
}

void VariantStore::sync() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail(path_, errno);
  durable_ = count_;
}

BlockRows VariantStore::get(std::uint64_t block) const {
  std::string bytes, reasons;
  if (!read(block, bytes, reasons))
    throw OutputError("cannot read block " + std::to_string(block) + " of " + path_);
  BlockRows rows;
  rows.numbers.resize(shape_.numbers);
  std::memcpy(rows.numbers.data(), bytes.data(), shape_.numbers * sizeof(double));
  rows.reasons = reasons_in(reasons);
  return rows;
}

void VariantStore::remove() {
  if (std::remove(path_.c_str()) != 0) fail(path_, errno);
}

}  // namespace drev::app
