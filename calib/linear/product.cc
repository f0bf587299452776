// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/product.h"

#include <cblas.h>

#include <algorithm>
#include <mutex>

#include "calib/linear/blas_kernels.h"
#include "calib/linear/blas_threads.h"

namespace mgtd::calib::linear {
namespace {

/// A run is judged beside the acquisition, and its digits must not depend on the number of processors.
[[maybe_unused]] const bool kReady = (take_fitting_kernels(), end_blas_threads(), true);

/// The library as it is built without threads of its own hands out its buffers without a lock: two threads
/// that call it at once may be given the same one. As it is built with threads it may be called at any time.
std::mutex one_at_a_time;
class Turn {
 public:
  Turn() {
    if (!kThreads) turn_.lock();
  }

 private:
  static inline const bool kThreads = openblas_get_parallel() != OPENBLAS_SEQUENTIAL;
  std::unique_lock<std::mutex> turn_{one_at_a_time, std::defer_lock};
};

using Columns = Eigen::Ref<const Eigen::MatrixXd>;

/// To arrange an A of so few numbers for BLAS takes longer than the product.
constexpr Eigen::Index kSmall = 64;

/// The leading dimension that BLAS takes, at least one.
template <class Matrix>
blasint lead(const Matrix& A) {
  return static_cast<blasint>(std::max<Eigen::Index>(1, A.outerStride()));
}

blasint size(Eigen::Index n) { return static_cast<blasint>(n); }

}  // namespace

void add_gram(const Columns& A, Eigen::MatrixXd& G) {
  const Turn turn;
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, size(A.cols()), size(A.rows()), 1, A.data(), lead(A), 1,
              G.data(), lead(G));
}

Eigen::MatrixXd gram(const Columns& A) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(A.cols(), A.cols());
  add_gram(A, out);
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

Eigen::MatrixXd transposed_product(const Columns& A, const Columns& B) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(A.cols(), B.cols());
  const Turn turn;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, size(A.cols()), size(B.cols()), size(A.rows()), 1,
              A.data(), lead(A), B.data(), lead(B), 0, out.data(), lead(out));
  return out;
}

Eigen::MatrixXf transposed_product(const Eigen::Ref<const Eigen::MatrixXf>& A,
                                   const Eigen::Ref<const Eigen::MatrixXf>& B) {
  Eigen::MatrixXf out = Eigen::MatrixXf::Zero(A.cols(), B.cols());
  const Turn turn;
  cblas_sgemm(CblasColMajor, CblasTrans, CblasNoTrans, size(A.cols()), size(B.cols()), size(A.rows()), 1,
              A.data(), lead(A), B.data(), lead(B), 0, out.data(), lead(out));
  return out;
}

void set_product(const Columns& A, const Columns& B, Eigen::MatrixXd& C) {
  if (A.size() <= kSmall) {
    C = A.lazyProduct(B);
    return;
  }
  const Turn turn;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, size(C.rows()), size(C.cols()), size(A.cols()), 1,
              A.data(), lead(A), B.data(), lead(B), 0, C.data(), lead(C));
}

void set_product(const Columns& A, const RowByRow& B, RowByRow& C) {
  if (A.size() <= kSmall) {
    constexpr Eigen::Index kTogether = 8;  // columns whose sums stay in registers
    Eigen::Index from = 0;
    for (; from + kTogether <= B.cols(); from += kTogether)
      for (Eigen::Index i = 0; i < A.rows(); ++i) {
        Eigen::Matrix<double, 1, kTogether> sum = A(i, 0) * B.row(0).segment<kTogether>(from);
        for (Eigen::Index k = 1; k < A.cols(); ++k) sum += A(i, k) * B.row(k).segment<kTogether>(from);
        C.row(i).segment<kTogether>(from) = sum;
      }
    const Eigen::Index rest = B.cols() - from;
    C.rightCols(rest) = A.lazyProduct(B.rightCols(rest));
    return;
  }
  const Turn turn;
  cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, size(C.rows()), size(C.cols()), size(A.cols()), 1,
              A.data(), lead(A), B.data(), lead(B), 0, C.data(), lead(C));
}

void subtract_product(const Columns& A, const Columns& B, Eigen::MatrixXd& C) {
  const Turn turn;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, size(C.rows()), size(C.cols()), size(A.cols()), -1,
              A.data(), lead(A), B.data(), lead(B), 1, C.data(), lead(C));
}

Eigen::MatrixXd triangle_product(const Columns& L, Eigen::MatrixXd Z) {
  const Turn turn;
  cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, size(Z.rows()),
              size(Z.cols()), 1, L.data(), lead(L), Z.data(), lead(Z));
  return Z;
}

}  // namespace mgtd::calib::linear
