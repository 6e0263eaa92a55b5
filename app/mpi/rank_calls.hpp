#pragma once
/// What drev wants of MPI, as C functions of a library of its own, lib/drev-mpi/drev_mpi.so, which alone is linked with
/// MPI: the command loads it where a launcher (mpirun, srun) has started it, and neither needs MPI nor starts it
/// otherwise. Called by one thread.
#ifdef __cplusplus
extern "C" {
#endif

struct DrevRankCalls {
  int version;  ///< kDrevRankCalls
  /// MPI_Init_thread; this process's number and how many there are.
  void (*begin)(int* rank, int* ranks);
  void (*end)(void);  ///< MPI_Finalize
  void (*send)(int to, const char* bytes, long count);
  /// Bytes of the next message that has come, and from whom; -1: none has.
  long (*arrived)(int* from);
  void (*receive)(int from, char* bytes, long count);
  void (*abort)(int code);                     ///< ends all processes
  void (*version_text)(char* text, int size);  ///< of the MPI library
};

#define DREV_RANK_CALLS_VERSION 1
typedef const struct DrevRankCalls* (*DrevRankCallsFunction)(void);  // drev_rank_calls

#ifdef __cplusplus
}
#endif
