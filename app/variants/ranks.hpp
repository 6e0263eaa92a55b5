#pragma once
/// The processes that share one study: this one alone, or the ranks of MPI if a launcher has started it.
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

struct DrevRankCalls;

namespace drev::app {

class Ranks {
 public:
  /// Uses MPI if the launcher's environment variables say that there are several processes, otherwise this
  /// one alone. Throws ModelError if there are several and drev has no MPI, or a different one from the
  /// launcher's.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }
  bool first() const { return rank_ == 0; }

  struct Message {
    int from = 0;
    std::string bytes;
  };
  void send(int to, const std::string& bytes) const;
  std::optional<Message> receive() const;  ///< the next message that has arrived
  [[noreturn]] void abort(int code) const;

 private:
  const DrevRankCalls* calls_ = nullptr;  // null: this process is alone
  int rank_ = 0, count_ = 1;
};

/// Whether a launcher (mpirun, srun) started this process together with others.
bool launched_beside_others();

}  // namespace drev::app
