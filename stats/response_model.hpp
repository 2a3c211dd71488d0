// A response as a function of the factors, learned from the cases of a campaign, with the error of what it says.
//
//   z_i = f(x_i) + e_i,   f ~ mean + Gaussian process,   cov[f(x), f(x')] = s^2 C(r),   e_i ~ N(0, g), independent
//   C(r) = (1 + sqrt(5) r + 5/3 r^2) exp(-sqrt(5) r)          Matern 5/2 (Rasmussen & Williams 2006, eq. 4.17)
//   r^2 = sum_j ((x_j - x'_j)/l_j)^2                           one length per feature, one (anisotropic) distance
//   or, with a learned linear map,  r^2 = |L^-1 U (x - x')|^2  U upper triangular with a diagonal of 1, L = diag(l)
//
// x: features scaled to their box, so that a length of 1 is the whole range; z: responses less their mean over their
// standard deviation. The constant mean is the generalised least-squares one. l, s^2, g and U maximise the marginal
// likelihood times the priors log l ~ N(0, 1.5^2), log g ~ N(log 0.02, 2^2), U_jk ~ N(0, 1): see
// response/likelihood.hpp. Errors are checked by leaving every case out in closed form (Dubrule 1983, Math. Geol. 15,
// 687) and, where the noise is not the same everywhere, widened or narrowed by the size of those residuals nearby:
// response/local_noise.hpp.
//
// On request, the logarithm of a positive response takes the response's place if that lowers the error: its scatter is
// then a share of its size. Means, errors and covariances are those of the log-normal response, in its own
// unit; intervals are symmetric about the mean as everywhere.
//
// Between 12 and 4,000 cases; of more, a subset that fills the space (greedy maximin) is what the model rests on.
// Same numbers in, same model out: the starts of the search are Sobol points and nothing is drawn.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// n rows of `dimensions` numbers each, row-major, not owned.
struct Rows {
    std::span<const double> values;
    std::size_t dimensions = 0;

    [[nodiscard]] std::size_t size() const { return dimensions == 0 ? 0 : values.size() / dimensions; }
    [[nodiscard]] std::span<const double> row(std::size_t i) const {
        return values.subspan(i * dimensions, dimensions);
    }
};

/// Why there is no answer: one sentence without a full stop, to be shown as it is.
struct Refusal {
    std::string sentence;
};

/// A double as such a sentence shows it.
[[nodiscard]] std::string shown(double x);

/// When the kernel learns a linear map of the features besides their lengths.
enum class LearnedMap {
    never,
    where_better,  ///< from 200 cases on, where it lowers the leave-one-out error
    always
};

/// Whether the logarithm of the response is modelled.
enum class LogResponse {
    never,
    where_better  ///< all values positive, the largest 2.5 times the least or more, and the error 3 % lower
};

struct ResponseModelOptions {
    std::vector<double> low = {};      ///< box of the features, one value each; empty: 0
    std::vector<double> high = {};     ///< empty: 1
    std::size_t starts = 6;            ///< searches of the likelihood
    std::size_t cases_in_fit = 500;    ///< at most so many decide the hyperparameters (all enter the prediction)
    std::size_t cases_followed = 800;  ///< of a logarithm with more: what was found is followed on so many
    std::size_t most_cases = 4000;     ///< of more, a subset that fills the space
    LearnedMap map = LearnedMap::where_better;
    LogResponse logarithm = LogResponse::never;
    double refused_error = 0.7;  ///< leave-one-out error, in sd, from which on the model is refused
};

/// With and without a logarithm the error is compared on at most so many cases.
inline constexpr std::size_t cases_compared = 2500;

/// What a model rests on and how good it is, on the cases it has seen, each left out.
struct ModelQuality {
    std::size_t cases = 0;                                                  ///< with a value
    std::size_t rests_on = 0;                                               ///< in the model
    std::size_t excluded = 0;                                               ///< without a finite value
    double leave_one_out_error = std::numeric_limits<double>::quiet_NaN();  ///< rms residual over the sd of responses
    double coverage_50 = std::numeric_limits<double>::quiet_NaN();          ///< share in their 50 % interval
    double coverage_95 = std::numeric_limits<double>::quiet_NaN();
    double noise_share = std::numeric_limits<double>::quiet_NaN();  ///< of the variance of the responses
    bool learned_map = false;
    bool logarithm = false;  ///< the model is one of the response's logarithm
    /// Leave-one-out error on the cases compared, NaN: not tried.
    double error_without_logarithm = std::numeric_limits<double>::quiet_NaN();
    double error_with_logarithm = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> lengths;    ///< per feature, in widths of the box
    std::vector<double> residuals;  ///< leave-one-out, observed minus predicted, in the unit of the response
    std::vector<double> errors;     ///< their predicted standard deviations (single run, local noise without the case)
    std::vector<std::size_t> used;  ///< rows of the input the two belong to
};

/// At one point, in the unit of the response.
struct Prediction {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double mean_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error of the mean
    double scatter = std::numeric_limits<double>::quiet_NaN();     ///< standard deviation of a single run about it
    bool inside = true;                                            ///< false: outside the box, an extrapolation
    /// Of the two errors, which rest on few cases nearby: intervals are Student's, not normal.
    double freedom = std::numeric_limits<double>::infinity();
    /// Of a probability, which is Phi of a normal number of this mean and standard deviation.
    struct Latent {
        double mean = 0, error = 0;
    };
    std::optional<Latent> latent = {};

    /// Ends of the 95 % interval of the mean: symmetric, but for a probability, whose interval lies within 0 to 1 and
    /// reaches to its mean, which rare large values may hold beyond the quantiles.
    [[nodiscard]] double mean_low() const;
    [[nodiscard]] double mean_high() const;
    /// Standard deviation of a single run about the predicted mean: sqrt(mean_error^2 + scatter^2).
    [[nodiscard]] double run_error() const;
    /// 95 % half-widths, of the mean and of a single run about its predicted mean.
    [[nodiscard]] double mean_half_width() const;
    [[nodiscard]] double run_half_width() const;
};

/// Cheap to copy.
class ResponseModel {
public:
    struct State;
    explicit ResponseModel(std::shared_ptr<const State> state) : state_(std::move(state)) {}

    /// Features of one point, in their own units (as the box was). Cost n^2.
    [[nodiscard]] Prediction predict(std::span<const double> features) const;
    [[nodiscard]] std::vector<Prediction> predict(Rows points) const;
    /// Means only: cost n per point.
    [[nodiscard]] std::vector<double> means(Rows points) const;
    /// The model with these cases added: hyperparameters, scale and local noise stay. Values may be fantasies.
    /// Throws std::invalid_argument where sizes differ or a number is not finite.
    [[nodiscard]] ResponseModel with_cases(Rows points, std::span<const double> values) const;

    [[nodiscard]] const ModelQuality& quality() const;
    [[nodiscard]] std::size_t dimensions() const;
    /// Prediction::freedom, the same at every point.
    [[nodiscard]] double freedom() const;
    [[nodiscard]] const State& state() const { return *state_; }

private:
    std::shared_ptr<const State> state_;
};

/// Fits. `points`: n rows of features, `values`: n responses; a value that is not finite is left out and counted.
/// Refuses: a feature that is not finite, fewer than max(12, 4 (d + 1)) values, a constant response, half of the
/// values equal, a leave-one-out error of `refused_error` or more. Throws std::invalid_argument where sizes do not
/// match or the box is empty.
[[nodiscard]] std::variant<ResponseModel, Refusal> fit_response(Rows points, std::span<const double> values,
                                                                const ResponseModelOptions& options = {});

}  // namespace grainsweep::stats
