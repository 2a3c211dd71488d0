#include "stats/response/kriging.hpp"

#include "stats/response/triangular.hpp"

#include <Eigen/Cholesky>

#include <algorithm>

namespace grainsweep::stats::response {
namespace {

constexpr Eigen::Index block = 256;  // points predicted at a time

Eigen::VectorXd solved(const Eigen::MatrixXd& factor, const Eigen::VectorXd& right) {
    const auto lower = factor.triangularView<Eigen::Lower>();
    return lower.transpose().solve(lower.solve(right));
}

void solve_weights(Kriging& k) {
    const Eigen::VectorXd ones = solved(k.factor, Eigen::VectorXd::Ones(k.size()));
    k.precision = ones.sum();
    k.mean_weights = ones / k.precision;
    k.mean = k.mean_weights.dot(k.values);
    k.weights = solved(k.factor, (k.values.array() - k.mean).matrix());
}

}  // namespace

std::optional<Kriging> solve_kriging(const Hyperparameters& h, const Eigen::MatrixXd& points,
                                     const Eigen::VectorXd& values) {
    Kriging k{h, mapped(h, points), values, {}, {}, {}, 0, 0};
    k.factor = covariance(h, k.points);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> llt(k.factor);
    if (llt.info() != Eigen::Success) return std::nullopt;
    solve_weights(k);
    return k;
}

std::optional<Kriging> extend_kriging(const Kriging& old, const Eigen::MatrixXd& points,
                                      const Eigen::VectorXd& values) {
    const Eigen::Index n = old.size(), m = values.size();
    const Eigen::MatrixXd added = mapped(old.h, points);
    Eigen::MatrixXd across = cross_covariance(old.h, old.points, added);
    old.factor.triangularView<Eigen::Lower>().solveInPlace(across);
    Eigen::MatrixXd corner = covariance(old.h, added);
    corner.triangularView<Eigen::Lower>() -= across.transpose() * across;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Lower> llt(corner);
    if (llt.info() != Eigen::Success) return std::nullopt;
    Kriging k{
        old.h, Eigen::MatrixXd(n + m, added.cols()), Eigen::VectorXd(n + m), Eigen::MatrixXd(n + m, n + m), {}, {}, 0,
        0};
    k.points << old.points, added;
    k.values << old.values, values;
    k.factor.topLeftCorner(n, n) = old.factor;
    k.factor.bottomLeftCorner(m, n) = across.transpose();
    k.factor.bottomRightCorner(m, m) = corner;
    solve_weights(k);
    return k;
}

KrigingPrediction predict(const Kriging& model, const Eigen::MatrixXd& at) {
    const Eigen::Index m = at.rows();
    KrigingPrediction p{Eigen::VectorXd(m), Eigen::VectorXd(m)};
    const auto lower = model.factor.triangularView<Eigen::Lower>();
    for (Eigen::Index first = 0; first < m; first += block) {
        const Eigen::Index count = std::min(block, m - first);
        Eigen::MatrixXd k = cross_covariance(model.h, model.points, at.middleRows(first, count));
        p.mean.segment(first, count) = (k.transpose() * model.weights).array() + model.mean;
        const Eigen::ArrayXd rest = 1 - model.precision * (k.transpose() * model.mean_weights).array();
        lower.solveInPlace(k);
        p.variance.segment(first, count) =
            (model.h.signal() - k.colwise().squaredNorm().transpose().array() + rest.square() / model.precision).max(0);
    }
    return p;
}

Eigen::VectorXd predict_means(const Kriging& model, const Eigen::MatrixXd& at) {
    Eigen::VectorXd mean(at.rows());
    for (Eigen::Index first = 0; first < at.rows(); first += block) {
        const Eigen::Index count = std::min(block, at.rows() - first);
        mean.segment(first, count) =
            (cross_covariance(model.h, model.points, at.middleRows(first, count)).transpose() * model.weights).array() +
            model.mean;
    }
    return mean;
}

Eigen::MatrixXd FoldWeights::predict(const Kriging& model, const Eigen::MatrixXd& at) const {
    Eigen::MatrixXd mean(at.rows(), weights.cols());
    for (Eigen::Index first = 0; first < at.rows(); first += block) {
        const Eigen::Index count = std::min(block, at.rows() - first);
        const Eigen::MatrixXd k = cross_covariance(model.h, model.points, at.middleRows(first, count));
        mean.middleRows(first, count).noalias() = k.transpose() * weights;
    }
    mean.rowwise() += means;
    return mean;
}

Eigen::MatrixXd inverse_of(const Kriging& model) {
    Eigen::MatrixXd b = model.factor;
    invert_lower(b);
    b = gram_of_lower(b);
    b.noalias() -= model.precision * model.mean_weights * model.mean_weights.transpose();
    return b;
}

FoldWeights leave_folds_out(const Kriging& model, const Eigen::MatrixXd& b,
                            const std::vector<std::vector<Eigen::Index>>& left_out) {
    const auto folds = static_cast<Eigen::Index>(left_out.size());
    FoldWeights result{Eigen::MatrixXd(model.size(), folds), Eigen::RowVectorXd(folds)};
    for (Eigen::Index s = 0; s < folds; ++s) {
        const auto& out = left_out[static_cast<std::size_t>(s)];
        result.weights.col(s) = model.weights;
        result.means(s) = model.mean;
        if (out.empty()) continue;
        const Eigen::VectorXd moved = Eigen::MatrixXd(b(out, out)).llt().solve(Eigen::VectorXd(model.weights(out)));
        result.weights.col(s) -= b(Eigen::all, out) * moved;
        for (const Eigen::Index i : out) result.weights(i, s) = 0;
        result.means(s) -= model.mean_weights(out).dot(moved);
    }
    return result;
}

LeftOut leave_one_out(const Kriging& model) {
    Eigen::MatrixXd inverse_factor = model.factor;
    invert_lower(inverse_factor);
    // B_ii = (K^-1)_ii - c_i^2 (1^T K^-1 1)
    const Eigen::ArrayXd b =
        gram_diagonal_of_lower(inverse_factor).array() - model.precision * model.mean_weights.array().square();
    return {model.weights.array() / b, 1 / b};
}

}  // namespace grainsweep::stats::response
