#pragma once
/// DIR/variants.partial.store: the rows of a study's variants, stored as they are computed, so that no block
/// that counts as done is lost by a killed process, a full disk or a power failure.
///
/// Its head has the study's description as text, with its checksum. After it each block of variants has a
/// place of its own, of equal length: the numbers of its rows, where the reasons of its variants (why they failed, or
/// their warnings) are, and the checksum of all this and of the block's number. The reasons follow behind all places, in the order
/// in which the blocks are stored, since most blocks have none. A block is done if its checksum is right; a
/// block that was being written when the process ended is detected by it and computed again. A place is
/// written once. Space for all places is reserved at the start, so that a disk that is too full is reported
/// before anything is computed.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace drev::app {

/// The results of a block of variants.
struct BlockRows {
  std::vector<double> numbers = {};  ///< numbers of the rows, row after row
  /// Why each variant failed, in the order of the rows, empty where it did not; those at the end that did not
  /// fail may be missing.
  std::vector<std::string> reasons = {};

  const std::string& reason(std::size_t row) const;
  /// Enters the reason of a row, cut to kReason bytes.
  void set_reason(std::size_t row, const std::string& reason);
  static constexpr std::size_t kReason = 200;
};

/// The reasons as bytes, each ended by a zero, and back.
std::string reasons_as_bytes(const std::vector<std::string>& reasons);
std::vector<std::string> reasons_in(const std::string& bytes);

struct StoreShape {
  std::uint64_t blocks = 0;
  std::size_t numbers = 0;  ///< count of numbers in each block
};

class VariantStore {
 public:
  /// The description of the study whose store is in the folder; nullopt: there is none that can be resumed.
  static std::optional<std::string> description_in(const std::string& folder);
  /// The number of its blocks that are done, and of all its blocks.
  static std::pair<std::uint64_t, std::uint64_t> progress_in(const std::string& folder);
  static std::string path_in(const std::string& folder);

  /// Creates a store, or (resume) opens an existing one of the same description and shape. Throws
  /// OutputError, also if another process is writing it or the disk has too little space.
  VariantStore(const std::string& folder, const std::string& description, StoreShape shape, bool resume);
  ~VariantStore();
  VariantStore(const VariantStore&) = delete;
  VariantStore& operator=(const VariantStore&) = delete;

  bool done(std::uint64_t block) const { return done_[block]; }
  std::uint64_t count() const { return count_; }      ///< blocks stored, including those found at the start
  std::uint64_t durable() const { return durable_; }  ///< blocks that would survive a power failure

  /// Stores a block. Throws OutputError; the block then is not done.
  void put(std::uint64_t block, const BlockRows& rows);
  /// Writes all stored blocks to the disk. Throws OutputError.
  void sync();
  /// Reads a block that is done. Throws OutputError if it cannot be read.
  BlockRows get(std::uint64_t block) const;
  /// Removes the file, when its rows are kept elsewhere.
  void remove();

  const std::string& path() const { return path_; }

 private:
  std::size_t place_size() const;
  std::uint64_t place(std::uint64_t block) const;
  bool read(std::uint64_t block, std::string& bytes, std::string& reasons) const;

  std::string path_;
  StoreShape shape_;
  std::uint64_t start_ = 0;  // position of the first block [bytes]
  std::uint64_t end_ = 0;    // position behind the last reason [bytes]
  std::uint64_t key_ = 0;    // checksum of the description
  int descriptor_ = -1;
  std::vector<bool> done_;
  std::uint64_t count_ = 0, durable_ = 0;
};

}  // namespace drev::app
