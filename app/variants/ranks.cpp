#include "app/variants/ranks.hpp"

#include <drev/core/error.hpp>
#include <drev/models/parameters.hpp>

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>

#include "app/mpi/rank_calls.hpp"

namespace drev::app {

namespace {

namespace fs = std::filesystem;

/// Environment variables with the number of processes: Open MPI, MPICH, Intel MPI, MVAPICH, and Slurm's srun.
constexpr const char* kCounts[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE",
                                   "SLURM_STEP_NUM_TASKS"};

[[noreturn]] void refuse(const std::string& why) {
  throw ModelError(std::vector<Finding>{{"MPI", "", "", "", why}});
}

int launched() {
  for (const char* name : kCounts)
    if (const char* text = std::getenv(name)) {
      double count = 0.0;
      if (read_number(text, count) && count > 1.0) return static_cast<int>(count);
    }
  return 1;
}

const DrevRankCalls* load() {
  constexpr const char* kLibrary = "drev_mpi.so";
  std::error_code none;
  const fs::path beside = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const char* folder : {"../lib/drev-mpi", "../" DREV_MPI_FOLDER}) {
    const fs::path path = beside / folder / kLibrary;
    if (!fs::exists(path, none)) continue;
    // MPI's own plugins look for its symbols among the global ones.
    void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) refuse("cannot be loaded: " + std::string(::dlerror()));
    const auto calls = reinterpret_cast<DrevRankCallsFunction>(::dlsym(library, "drev_rank_calls"));
    if (calls == nullptr || calls()->version != DREV_RANK_CALLS_VERSION)
      refuse(path.string() + " is of another version of drev");
    return calls();
  }
  refuse("was started " + std::to_string(launched()) +
         " times beside one another by mpirun or srun, but this drev was built without MPI: install an MPI "
         "(Debian: libopenmpi-dev, openmpi-bin) and build it again, or start it once");
}

}  // namespace

bool launched_beside_others() { return launched() > 1; }

Ranks::Ranks() {
  if (!launched_beside_others()) return;
  calls_ = load();
  calls_->begin(&rank_, &count_);
  if (count_ > 1) return;
  char version[256];
  calls_->version_text(version, sizeof version);
  calls_->end();
  calls_ = nullptr;
  refuse("the launcher started " + std::to_string(launched()) +
         " processes, but each sees itself alone: it does not "
         "belong to the MPI that drev was built with, " +
         std::string(version));
}

Ranks::~Ranks() {
  if (calls_ != nullptr) calls_->end();
}

void Ranks::send(int to, const std::string& bytes) const {
  calls_->send(to, bytes.data(), static_cast<long>(bytes.size()));
}

std::optional<Ranks::Message> Ranks::receive() const {
  if (calls_ == nullptr) return {};
  Message message;
  const long size = calls_->arrived(&message.from);
  if (size < 0) return {};
  message.bytes.resize(static_cast<std::size_t>(size));
  calls_->receive(message.from, message.bytes.data(), size);
  return message;
}

void Ranks::abort(int code) const {
  if (calls_ != nullptr) calls_->abort(code);
  std::_Exit(code);
}

}  // namespace drev::app
