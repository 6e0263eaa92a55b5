#pragma once
/// The routines of LAPACK (Anderson et al., LAPACK Users' Guide, 1999) that drev calls, as Fortran compilers name them: the
/// lengths of character arguments stand last. Matrices are stored by columns.
#include <complex>
#include <cstddef>
#include <vector>

extern "C" {

/// Eigenvalues and right eigenvectors of a general matrix, balanced first.
void dgeev_(const char* left, const char* right, const int* n, double* a, const int* lda, double* real,
            double* imaginary, double* vl, const int* ldvl, double* vr, const int* ldvr, double* work,
            const int* lwork, int* info, std::size_t left_length, std::size_t right_length);

/// The shortest least-squares solution, by a complete orthogonal factorisation.
void dgelsy_(const int* m, const int* n, const int* nrhs, double* a, const int* lda, double* b,
             const int* ldb, int* jpvt, const double* rcond, int* rank, double* work, const int* lwork,
             int* info);

/// A P = Q R with column pivoting, Q as reflections.
void dgeqp3_(const int* m, const int* n, double* a, const int* lda, int* jpvt, double* tau, double* work,
             const int* lwork, int* info);

/// The columns of Q from its reflections.
void dorgqr_(const int* m, const int* n, const int* k, double* a, const int* lda, const double* tau,
             double* work, const int* lwork, int* info);

/// Eigenvalues in ascending order and orthonormal eigenvectors, in the place of A, of a symmetric matrix, by divide and
/// conquer.
void dsyevd_(const char* vectors, const char* triangle, const int* n, double* a, const int* lda,
             double* values, double* work, const int* lwork, int* iwork, const int* liwork, int* info,
             std::size_t vectors_length, std::size_t triangle_length);

/// A x = b by elimination with row pivoting; info > 0 where A is singular.
void zgesv_(const int* n, const int* nrhs, std::complex<double>* a, const int* lda, int* pivots,
            std::complex<double>* b, const int* ldb, int* info);
}

namespace drev {

/// Calls routine(work, lwork) for the size of its workspace (lwork -1), then with it.
template <class Routine>
void with_workspace(const Routine& routine) {
  double size = 1.0;
  int lwork = -1;
  routine(&size, &lwork);
  std::vector<double> work(static_cast<std::size_t>(lwork = static_cast<int>(size)));
  routine(work.data(), &lwork);
}

}  // namespace drev
