// Model of a response as a function of the factors, fitted to the cases of a campaign, with the errors of its
// predictions.
//
//   z_i = f(x_i) + e_i,   f ~ mean + Gaussian process,   cov[f(x), f(x')] = s^2 C(r),   e_i ~ N(0, g), independent
//   C(r) = (1 + sqrt(5) r + 5/3 r^2) exp(-sqrt(5) r)          Matern 5/2 (Rasmussen & Williams 2006, eq. 4.17)
//   r^2 = sum_j ((x_j - x'_j)/l_j)^2                           one length per feature, one (anisotropic) distance
//   or, with a learned linear map,  r^2 = |L^-1 U (x - x')|^2  U upper triangular with a diagonal of 1, L = diag(l)
//
// x: features scaled to their box, so that a length of 1 is the whole range. z: (response - mean)/(standard deviation).
// The constant mean is estimated by generalised least squares. l, s^2, g and U maximise the marginal likelihood times
// the priors log l ~ N(0, 1.5^2), log g ~ N(log 0.02, 2^2), U_jk ~ N(0, 1): response/likelihood.hpp. Errors are checked
// by leaving out every case in closed form (Dubrule 1983, Math. Geol. 15, 687). If the noise varies in space, they are
// scaled by the size of these residuals nearby: response/local_noise.hpp.
//
// On request, the logarithm of a positive response is modelled if that lowers the error. Its scatter is then
// proportional to its size. Means, errors and covariances are those of the log-normal response, in its own unit;
// intervals are symmetric around the mean.
//
// A model uses 12 to 4,000 cases; of more cases it uses a space-filling subset (greedy maximin). The same input gives
// the same model: the starts of the search are Sobol points and no random numbers are used.
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

/// View of n rows of `dimensions` numbers each, row-major.
struct Rows {
    std::span<const double> values;
    std::size_t dimensions = 0;

    [[nodiscard]] std::size_t size() const { return dimensions == 0 ? 0 : values.size() / dimensions; }
    [[nodiscard]] std::span<const double> row(std::size_t i) const {
        return values.subspan(i * dimensions, dimensions);
    }
};

/// Reason why there is no model: one sentence without a full stop, to be shown to the user.
struct Refusal {
    std::string sentence;
};

/// Returns a number as text for such a sentence.
[[nodiscard]] std::string shown(double x);

/// Choice whether the kernel has a linear map of the features besides their lengths.
enum class LearnedMap {
    never,
    where_better,  ///< from 200 cases on, if it lowers the leave-one-out error
    always
};

/// Choice whether the logarithm of the response is modelled.
enum class LogResponse {
    never,
    where_better  ///< if all values are positive, the largest is at least 2.5 times the smallest, and the error is 3 %
                  ///< lower
};

/// What the noise of a model stands for: scatter of single runs, or misfit of a response that has none. Single runs
/// cannot tell: it is misfit where at least three settings come again, all with the value that they had.
enum class Noise { scatter, misfit };

struct ResponseModelOptions {
    std::vector<double> low = {};      ///< box of the features, one value each; empty: 0
    std::vector<double> high = {};     ///< empty: 1
    std::size_t starts = 6;            ///< starts of the search
    std::size_t cases_in_fit = 500;    ///< most cases for the hyperparameters; the prediction uses all cases
    std::size_t cases_followed = 800;  ///< for a logarithm with more cases, the maximum is followed on so many
    std::size_t most_cases = 4000;     ///< of more cases, a space-filling subset is used
    LearnedMap map = LearnedMap::where_better;
    LogResponse logarithm = LogResponse::never;
    double refused_error = 0.7;  ///< leave-one-out error, in sd, from which on the model is refused
};

/// Most cases on which the errors with and without a logarithm are compared.
inline constexpr std::size_t cases_compared = 2500;

/// Quality of a model, from its cases, each left out in turn.
struct ModelQuality {
    std::size_t cases = 0;                                                  ///< with a value
    std::size_t rests_on = 0;                                               ///< in the model
    std::size_t excluded = 0;                                               ///< without a finite value
    double leave_one_out_error = std::numeric_limits<double>::quiet_NaN();  ///< rms residual divided by the sd of the
                                                                            ///< responses
    double coverage_50 = std::numeric_limits<double>::quiet_NaN();          ///< share of cases in their 50 % interval
    double coverage_95 = std::numeric_limits<double>::quiet_NaN();
    double noise_share =
        std::numeric_limits<double>::quiet_NaN();  ///< share of scatter in the variance of the responses
    Noise noise = Noise::scatter;
    bool learned_map = false;
    bool logarithm = false;  ///< the logarithm of the response is modelled
    /// Leave-one-out error on the cases compared; NaN: not tried.
    double error_without_logarithm = std::numeric_limits<double>::quiet_NaN();
    double error_with_logarithm = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> lengths;    ///< per feature, in widths of the box
    std::vector<double> residuals;  ///< leave-one-out, observed minus predicted, in the unit of the response
    std::vector<double> errors;     ///< their predicted standard deviations (single run, local noise without the case)
    std::vector<std::size_t> used;  ///< rows of the input to which residuals and errors belong
};

/// Prediction at one point, in the unit of the response.
struct Prediction {
    double mean = std::numeric_limits<double>::quiet_NaN();
    double mean_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error of the mean
    double scatter = std::numeric_limits<double>::quiet_NaN();     ///< standard deviation of a single run around the
                                                                   ///< mean
    bool inside = true;                                            ///< false: outside the box, an extrapolation
    /// Degrees of freedom of the two errors. They are estimated from few cases nearby, so intervals are Student's, not
    /// normal.
    double freedom = std::numeric_limits<double>::infinity();
    /// The scatter if the noise were the same everywhere; NaN: as `scatter`.
    double even_scatter = std::numeric_limits<double>::quiet_NaN();
    /// For a probability Phi(f): mean and standard deviation of the normal f.
    struct Latent {
        double mean = 0, error = 0;
    };
    std::optional<Latent> latent = {};

    /// Return the ends of the 95 % interval of the mean. It is symmetric, except for a probability: there it lies
    /// within 0 to 1 and includes the mean, which rare large values can move beyond the quantiles.
    [[nodiscard]] double mean_low() const;
    [[nodiscard]] double mean_high() const;
    /// Returns the standard deviation of a single run around the predicted mean: sqrt(mean_error^2 + scatter^2).
    [[nodiscard]] double run_error() const;
    /// Return the 95 % half-widths of the mean, and of a single run around the predicted mean.
    [[nodiscard]] double mean_half_width() const;
    [[nodiscard]] double run_half_width() const;
};

/// Fitted model. Cheap to copy.
class ResponseModel {
public:
    struct State;
    explicit ResponseModel(std::shared_ptr<const State> state) : state_(std::move(state)) {}

    /// Returns the prediction at the features of one point, in their own units. Cost n^2.
    [[nodiscard]] Prediction predict(std::span<const double> features) const;
    [[nodiscard]] std::vector<Prediction> predict(Rows points) const;
    /// Returns only the means. Cost: n per point.
    [[nodiscard]] std::vector<double> means(Rows points) const;
    /// Returns the model with these cases added and the same hyperparameters, scale and local noise. The values may be
    /// assumed instead of computed. Throws std::invalid_argument if sizes differ or a number is not finite.
    [[nodiscard]] ResponseModel with_cases(Rows points, std::span<const double> values) const;

    [[nodiscard]] const ModelQuality& quality() const;
    [[nodiscard]] std::size_t dimensions() const;
    /// Returns Prediction::freedom, the same at every point.
    [[nodiscard]] double freedom() const;
    [[nodiscard]] const State& state() const { return *state_; }

private:
    std::shared_ptr<const State> state_;
};

/// Fits a model. `points`: n rows of features; `values`: n responses, of which values that are not finite are left out
/// and counted. Refuses a feature that is not finite, fewer than max(12, 4 (d + 1)) values, a constant response, half
/// of the values equal, and a leave-one-out error of `refused_error` or more. Throws std::invalid_argument if sizes do
/// not match or the box is empty.
[[nodiscard]] std::variant<ResponseModel, Refusal> fit_response(Rows points, std::span<const double> values,
                                                                const ResponseModelOptions& options = {});

}  // namespace grainsweep::stats
