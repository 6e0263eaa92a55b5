#include "app/variants/variant_work.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>
#include <unistd.h>

#include "app/base/checksum.hpp"
#include "app/base/interrupt.hpp"
#include "app/base/output_file.hpp"
#include "app/base/progress.hpp"
#include "app/variants/block_threads.hpp"

namespace drev::app {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// The first byte of a message. It is followed, after hello, by the description's checksum and the host;
/// after found, by a FoundRows, its numbers and reasons; after bye, by the reason (empty: it was told to end);
/// after task, by a BlockTask.
enum : char { kHello = 'H', kAsk = 'A', kFound = 'F', kBye = 'B', kTask = 'T', kOver = 'O' };

struct FoundRows {
  std::uint64_t block, numbers;
  double seconds;
};

constexpr double kTaskSeconds = 0.25;  // time that a task should take [s]
constexpr auto kSyncEvery = milliseconds(500), kTellEvery = milliseconds(60000);

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <class T>
std::string message_of(char kind, const T& value) {
  std::string bytes(1, kind);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  return bytes;
}

template <class T>
T value_in(const std::string& bytes) {
  T value{};
  std::memcpy(&value, bytes.data() + 1, std::min(sizeof value, bytes.size() - 1));
  return value;
}

std::string message_of(const FoundBlock& found) {
  std::string bytes = message_of(kFound, FoundRows{found.block, found.rows.numbers.size(), found.seconds});
  bytes.append(reinterpret_cast<const char*>(found.rows.numbers.data()),
               found.rows.numbers.size() * sizeof(double));
  return bytes + reasons_as_bytes(found.rows.reasons);
}

FoundBlock found_in(const std::string& bytes) {
  const auto head = value_in<FoundRows>(bytes);
  FoundBlock found{head.block, head.seconds, {}};
  found.rows.numbers.resize(head.numbers);
  const char* numbers = bytes.data() + 1 + sizeof head;
  std::memcpy(found.rows.numbers.data(), numbers, head.numbers * sizeof(double));
  found.rows.reasons = reasons_in(bytes.substr(1 + sizeof head + head.numbers * sizeof(double)));
  return found;
}

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "an unknown host";
}

std::uint64_t identity(const VariantStudy& study) { return checksum(study.description().dump()); }

/// The first rank, which hands out the work.
class Leader {
 public:
  Leader(const VariantStudy& study, const Ranks& ranks, int threads, VariantStore& store)
      : study_(study),
        ranks_(ranks),
        threads_(threads),
        store_(store),
        left_(static_cast<std::size_t>(ranks.count()) - 1),
        begun_(store.count()) {}

  WorkOutcome run() {
    try {
      work();
    } catch (...) {
      end_others();
      throw;
    }
    end_others();
    store_.sync();
    outcome_.seconds = since(start_);
    outcome_.computed = (store_.count() - begun_) * study_.block_size();
    return outcome_;
  }

 private:
  void work() {
    BlockThreads own(study_, threads_);
    const milliseconds wait(ranks_.count() > 1 ? 1 : 20);
    while (store_.count() < study_.blocks() && !ended_) {
      if (interrupted()) {
        outcome_.interrupted = true;
        return;
      }
      while (own.wants_more()) {
        const BlockTask task = next_task();
        if (task.count == 0) break;
        own.give(task);
      }
      for (const FoundBlock& found : own.take(wait)) enter(found);
      while (const auto message = ranks_.receive()) answer(*message);
      if (store_.durable() < store_.count() && Clock::now() - synced_ >= kSyncEvery) {
        store_.sync();
        synced_ = Clock::now();
      }
      tell();
    }
    progress_.clear();
  }

  /// The next blocks that are neither done nor handed out; count 0: there are none. Their number follows from
  /// the time of a block and from the number of blocks left for all.
  BlockTask next_task() {
    while (next_ < study_.blocks() && store_.done(next_)) ++next_;
    BlockTask task{next_, 0};
    const double share = static_cast<double>(study_.blocks() - next_) /
                         (4.0 * static_cast<double>(ranks_.count()) * static_cast<double>(threads_));
    const double fit = seconds_ > 0.0 ? kTaskSeconds / seconds_ : 1.0;
    const auto most = static_cast<std::uint64_t>(std::clamp(std::min(fit, share), 1.0, 4096.0));
    while (task.count < most && next_ < study_.blocks() && !store_.done(next_)) ++next_, ++task.count;
    return task;
  }

  void enter(const FoundBlock& found) {
    store_.put(found.block, found.rows);
    seconds_ = seconds_ == 0.0 ? found.seconds : 0.95 * seconds_ + 0.05 * found.seconds;
    for (std::uint64_t i = 0; i < study_.count_of(found.block); ++i)
      if (found.rows.numbers[i * study_.row_size()] != 0.0) ++failed_;
  }

  void answer(const Ranks::Message& message) {
    switch (message.bytes.front()) {
      case kHello:
        if (value_in<std::uint64_t>(message.bytes) == identity(study_)) return;
        ended_ = true;
        outcome_.fault = "rank " + std::to_string(message.from) + " on " +
                         message.bytes.substr(1 + sizeof(std::uint64_t)) +
                         " has another model, other options or another drev than rank 0";
        return;
      case kAsk: {
        const BlockTask task = next_task();
        if (task.count > 0) ranks_.send(message.from, message_of(kTask, task));
        return;  // otherwise it is told of the end with all others
      }
      case kFound:
        return enter(found_in(message.bytes));
      case kBye:
        --left_;
        ended_ = true;
        if (message.bytes.size() > 1)
          outcome_.fault = "rank " + std::to_string(message.from) + ": " + message.bytes.substr(1);
        else
          outcome_.interrupted = true;  // it was told to end before this rank
        return;
      default:
        return;
    }
  }

  /// Ends all other ranks; the rows that they have computed by then are kept if possible.
  void end_others() {
    for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.send(rank, std::string(1, kOver));
    bool writable = true;
    while (left_ > 0) {
      const auto message = ranks_.receive();
      if (!message) {
        std::this_thread::sleep_for(milliseconds(1));
        continue;
      }
      if (message->bytes.front() == kBye) --left_;
      if (message->bytes.front() == kFound && writable) try {
          enter(found_in(message->bytes));
        } catch (const OutputError&) {
          writable = false;
        }
    }
  }

  void tell() {
    const std::uint64_t done = std::min(store_.durable() * study_.block_size(), study_.plan().count());
    const auto now = static_cast<double>(store_.count() - begun_),
               rest = static_cast<double>(study_.blocks() - store_.count());
    std::string text = std::to_string(done) + " of " + std::to_string(study_.plan().count()) + " done";
    if (failed_ > 0) text += ", " + std::to_string(failed_) + " failed";
    if (now > 0.0) text += ", " + rough_time(since(start_) / now * rest) + " left";
    progress_.show(text);
    if (::isatty(STDERR_FILENO) != 0 || Clock::now() - told_ < kTellEvery) return;
    told_ = Clock::now();  // for the log file of a batch system
    std::fprintf(stderr, "drev: %s: %s\n", rough_time(since(start_)).c_str(), text.c_str());
  }

  const VariantStudy& study_;
  const Ranks& ranks_;
  int threads_;
  VariantStore& store_;
  std::size_t left_;          // number of ranks that have not ended
  std::uint64_t begun_ = 0;   // number of blocks done at the start
  std::uint64_t next_ = 0;    // next block to hand out
  std::uint64_t failed_ = 0;  // number of variants that failed in this run
  double seconds_ = 0.0;      // time of a block, smoothed [s]
  bool ended_ = false;        // true: ended before all blocks were done
  WorkOutcome outcome_;
  Progress progress_;
  Clock::time_point start_ = Clock::now(), synced_ = start_, told_ = start_;
};

}  // namespace

WorkOutcome lead_work(const VariantStudy& study, const Ranks& ranks, int threads, VariantStore& store) {
  return Leader(study, ranks, threads, store).run();
}

void follow_work(const VariantStudy& study, const Ranks& ranks, int threads) {
  ranks.send(0, message_of(kHello, identity(study)) + host_name());
  std::string why;
  try {
    BlockThreads own(study, threads);
    bool asked = false, over = false;
    while (!over && !interrupted()) {
      if (!asked && own.wants_more()) {
        ranks.send(0, std::string(1, kAsk));
        asked = true;
      }
      for (const FoundBlock& found : own.take(milliseconds(1))) ranks.send(0, message_of(found));
      while (const auto message = ranks.receive()) {
        over = over || message->bytes.front() == kOver;
        if (message->bytes.front() != kTask) continue;
        own.give(value_in<BlockTask>(message->bytes));
        asked = false;
      }
    }
  } catch (const std::exception& error) {
    why = std::string("on ") + host_name() + ": " + error.what();
  }
  ranks.send(0, std::string(1, kBye) + why);
}

void decline_work(const Ranks& ranks, const std::string& why) {
  if (!ranks.first()) return ranks.send(0, std::string(1, kBye) + why);
  for (int rank = 1; rank < ranks.count(); ++rank) ranks.send(rank, std::string(1, kOver));
  for (int left = ranks.count() - 1; left > 0;) {
    const auto message = ranks.receive();
    if (message && message->bytes.front() == kBye) --left;
    if (!message) std::this_thread::sleep_for(milliseconds(1));
  }
}

}  // namespace drev::app
