// drev_mpi.so: the functions of rank_calls.hpp by MPI's C interface, whichever implementation it was built with.
#include <cstdio>
#include <mpi.h>

#include "app/mpi/rank_calls.hpp"

namespace {

constexpr int kTag = 1;

void begin(int* rank, int* ranks) {
  int given = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
  MPI_Comm_rank(MPI_COMM_WORLD, rank);
  MPI_Comm_size(MPI_COMM_WORLD, ranks);
}

void end() { MPI_Finalize(); }

void send(int to, const char* bytes, long count) {
  MPI_Send(bytes, static_cast<int>(count), MPI_BYTE, to, kTag, MPI_COMM_WORLD);
}

long arrived(int* from) {
  int any = 0, count = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &any, &status);
  if (any == 0) return -1;
  MPI_Get_count(&status, MPI_BYTE, &count);
  *from = status.MPI_SOURCE;
  return count;
}

void receive(int from, char* bytes, long count) {
  MPI_Recv(bytes, static_cast<int>(count), MPI_BYTE, from, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void abort_all(int code) { MPI_Abort(MPI_COMM_WORLD, code); }

void version_text(char* text, int size) {
  char library[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(library, &length);
  std::snprintf(text, static_cast<std::size_t>(size), "%s", library);
}

constexpr DrevRankCalls kCalls{
    DREV_RANK_CALLS_VERSION, begin, end, send, arrived, receive, abort_all, version_text};

}  // namespace

extern "C" __attribute__((visibility("default"))) const DrevRankCalls* drev_rank_calls() { return &kCalls; }
