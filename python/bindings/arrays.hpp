#pragma once
/// C++ arrays as NumPy arrays without a copy: the array keeps the object alive to which its memory belongs.
#include <Eigen/Core>
#include <complex>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <vector>

namespace drev::python {

namespace nb = nanobind;

template <class T>
using ReadOnly = nb::ndarray<nb::numpy, const T>;

template <class T>
ReadOnly<T> array_of(const std::vector<T>& values, nb::handle owner) {
  return ReadOnly<T>(values.data(), {values.size()}, owner);
}

/// A matrix as an array of rows x columns, with its first `columns` columns.
template <class T>
ReadOnly<T> matrix_of(const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>& matrix, std::size_t columns,
                      nb::handle owner) {
  const auto rows = static_cast<std::size_t>(matrix.rows());
  return ReadOnly<T>(matrix.data(), {rows, columns}, owner, {1, static_cast<std::int64_t>(rows)});
}

}  // namespace drev::python
