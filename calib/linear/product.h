// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>

/// These functions multiply large matrices by OpenBLAS, which has kernels for each kind of processor and
/// takes those of the one it runs on (blas_kernels.h); Eigen's are compiled for the oldest. Each product is
/// made by one thread; several may ask at once, and wait for each other where the library was built without
/// threads. The last digits differ between kinds of processors, so no calibration is made of these products:
/// they are for tests and draws.
namespace mgtd::calib::linear {

/// A'A, n x n of A with n columns.
[[nodiscard]] Eigen::MatrixXd gram(const Eigen::Ref<const Eigen::MatrixXd>& A);
/// G becomes G + A'A, in its lower triangle alone.
void add_gram(const Eigen::Ref<const Eigen::MatrixXd>& A, Eigen::MatrixXd& G);
/// A'B; both have the same number of rows.
[[nodiscard]] Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                                 const Eigen::Ref<const Eigen::MatrixXd>& B);
[[nodiscard]] Eigen::MatrixXf transposed_product(const Eigen::Ref<const Eigen::MatrixXf>& A,
                                                 const Eigen::Ref<const Eigen::MatrixXf>& B);
/// C becomes A B; it has that size already.
void set_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                 Eigen::MatrixXd& C);
/// The same where B and C lie row by row: of a small A and many columns the fastest.
using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
void set_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const RowByRow& B, RowByRow& C);
/// C becomes C - A B.
void subtract_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                      Eigen::MatrixXd& C);
/// L Z of the lower triangle of L, with its diagonal.
[[nodiscard]] Eigen::MatrixXd triangle_product(const Eigen::Ref<const Eigen::MatrixXd>& L, Eigen::MatrixXd Z);

}  // namespace mgtd::calib::linear
