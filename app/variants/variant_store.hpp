#pragma once
/// DIR/variants.partial.store: the rows of a study's variants as they are found, so that nothing which counts as
/// done is lost by a killed process, a full disk or a power cut.
///
/// Its head has the study's description as text, with its checksum. Behind it each block of variants has a place
/// of its own, of equal length: the numbers of its rows, a reason where a variant failed, and the checksum of both
/// and of the block's number. A block is done when its checksum is right; what was being written when the process
/// ended is found by it, and is computed again. A place is written once. Room for all is taken at the start, so
/// that a disk that is too full says so before anything is computed.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace drev::app {

/// What a block of variants gives.
struct BlockRows {
  std::vector<double> numbers = {};  ///< row after row
  std::string reason = {};  ///< of its first variant that failed; empty: none did. Cut to kReason bytes
};

struct StoreShape {
  std::uint64_t blocks = 0;
  std::size_t numbers = 0;  ///< of each block
};

class VariantStore {
 public:
  static constexpr std::size_t kReason = 200;

  /// The description of the study whose store is in the folder; nullopt: none that could be gone on with.
  static std::optional<std::string> description_in(const std::string& folder);
  /// How many blocks of it are done, and of how many.
  static std::pair<std::uint64_t, std::uint64_t> progress_in(const std::string& folder);
  static std::string path_in(const std::string& folder);

  /// A new one, or (resume) the one that is there, of the same description and shape. Throws OutputError, also
  /// when another process is writing it or the disk has not the room.
  VariantStore(const std::string& folder, const std::string& description, StoreShape shape, bool resume);
  ~VariantStore();
  VariantStore(const VariantStore&) = delete;
  VariantStore& operator=(const VariantStore&) = delete;

  bool done(std::uint64_t block) const { return done_[block]; }
  std::uint64_t count() const { return count_; }      ///< blocks put, those found at the start among them
  std::uint64_t durable() const { return durable_; }  ///< blocks that a power cut would leave

  /// Throws OutputError; the block then is not done.
  void put(std::uint64_t block, const BlockRows& rows);
  /// To the disk. Throws OutputError.
  void sync();
  /// A block that is done. Throws OutputError where it cannot be read back.
  BlockRows get(std::uint64_t block) const;
  /// Takes the file away: its rows are kept elsewhere.
  void remove();

  const std::string& path() const { return path_; }

 private:
  std::size_t place_size() const;
  std::uint64_t place(std::uint64_t block) const;
  bool read(std::uint64_t block, std::string& bytes) const;

  std::string path_;
  StoreShape shape_;
  std::uint64_t start_ = 0;  // of the first block's place
  std::uint64_t key_ = 0;    // the description's checksum
  int descriptor_ = -1;
  std::vector<bool> done_;
  std::uint64_t count_ = 0, durable_ = 0;
};

}  // namespace drev::app
