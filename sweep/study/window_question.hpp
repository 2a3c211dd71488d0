// Question about a process window: condition, objective, models, and their judgement of settings.
//
//   P(x) = E_noise [ answers(x) sum over the subsets U of the observables that can be undefined of
//          prod_{k in U} (1 - d_k(x)) prod_{k not in U} d_k(x) P(condition holds | those in U undefined) ]
//
// answers: answers.hpp; d_k: probability that observable k is defined. With `for all`, P is the smallest of the levels.
// A comparison with an undefined value is not true, and the condition does not hold where the objective is undefined.
// Noise and levels: window_space.hpp. Objective and responses are averages over the noise factors. Their error is the
// mean error, because errors of one model are correlated. Their scatter includes single runs and the variation of the
// means with the noise factors.
#pragma once

#include "stats/process_window.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/condition.hpp"
#include "sweep/study/response_models.hpp"
#include "sweep/study/window_space.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::study {

struct Objective {
    std::string name;  ///< observable or factor
    bool maximise = true;
    /// Of two objectives: a value that is no better does not count. Empty: the worst value of the computed cases.
    std::optional<double> reference{};
};

struct WindowRequest {
    std::string where{};                  ///< condition; empty: holds everywhere; may end with "for all NAME"
    std::vector<Objective> objectives{};  ///< at most two; empty: the setting with the largest probability is best
    double risk = 0.05;
    stats::Judged judged = stats::Judged::mean;
    std::size_t next = 0;           ///< number of next cases to propose
    std::size_t candidates = 4096;  ///< Sobol points of the box; a quarter of them if factors are averaged
    Held held{};
    std::vector<campaign::Outcome> left_out{};  ///< outcomes of failed cases that are not used
    /// Called with the name of the step and the part of it that is done, from 0 to 1; may be empty.
    std::function<void(std::string_view step, double done)> progress{};
};

/// Setting with the predictions of the models.
struct Judgement {
    Setting setting;                              ///< NaN: the factor is averaged over
    std::vector<stats::Prediction> predictions;   ///< one per model
    std::vector<double> defined;                  ///< one per model: probability that the observable is defined
    std::vector<stats::Prediction> objectives{};  ///< one per objective; of a factor its value, without error
    double answers = 1;                           ///< probability that a case has an answer
    double answers_low = 1, answers_high = 1;     ///< ends of its 95 % interval
    bool believed = true;                         ///< an answer is more likely than a failure, and every feature is
                                                  ///< defined
    double probability = std::numeric_limits<double>::quiet_NaN();
    /// Where asked for: the probability if the mean of a model is known, and lies at the lower and at the upper end of
    /// its 95 % interval; two for each model.
    std::vector<double> at_ends = {};
};

/// Objective and the origin of its value: a factor or a model.
struct Goal {
    double sign = 1;  ///< -1: minimised
    std::optional<std::size_t> factor, model;
    double reference = 0;  ///< of two objectives
};

class WindowQuestion {
public:
    /// `learned`, `answers`: models that are already fitted.
    WindowQuestion(const ModelCases& cases, const WindowRequest& request, Admits admits,
                   std::span<const ObservableModel> learned = {}, std::shared_ptr<const Answers> answers = nullptr);

    /// Returns the judgement of settings by the campaign's models. Reports progress under the name
    /// `step`. The first `doubted` have `at_ends`.
    [[nodiscard]] std::vector<Judgement> judge(std::span<const Setting> settings, std::string_view step = {},
                                               std::size_t doubted = 0) const;
    /// Returns the judgement of settings by the models in `by`, which are in the order of models().
    [[nodiscard]] std::vector<Judgement> judge_by(std::span<const ObservableModel> by,
                                                  std::span<const Setting> settings, std::size_t doubted = 0) const;
    /// Reports progress, if somebody listens.
    void report(std::string_view step, double done) const {
        if (request_->progress) request_->progress(step, done);
    }
    /// Returns the full setting of a window's setting (window_space.hpp) at which a case is most informative: the
    /// largest error of the first model, or the probability nearest to 1/2.
    [[nodiscard]] Setting least_known(std::span<const ObservableModel> by, const Setting& setting) const;

    /// Returns whether `a` is better than `b`: by worth() if the condition holds with probability 1 - risk, else by the
    /// probability. Settings with a certain answer, answers_low >= 1 - risk, come before all others. Reason: if
    /// cases fail beyond a sharp border and the objective grows towards it, the best setting would be where P has just
    /// fallen to 1 - risk. One of 20 such settings lies beyond the border.
    [[nodiscard]] bool better(const Judgement& a, const Judgement& b) const;
    /// Returns the objective less one standard error, because the largest mean alone is as often an error as a peak. Of
    /// two objectives, the product of the gains of both over the reference.
    [[nodiscard]] double worth(const Judgement& one) const;
    [[nodiscard]] bool meets(const Judgement& one) const { return meets(one.probability); }
    [[nodiscard]] bool meets(double probability) const { return probability >= 1 - request_->risk; }

    [[nodiscard]] const WindowSpace& space() const { return space_; }
    [[nodiscard]] const std::shared_ptr<const Answers>& answers() const { return answers_; }
    [[nodiscard]] const std::optional<Condition>& condition() const { return condition_; }
    [[nodiscard]] const std::vector<ObservableModel>& models() const { return models_; }
    [[nodiscard]] std::size_t name_of_model(std::size_t model) const { return name_of_model_[model]; }
    /// Returns one goal per objective of the request.
    [[nodiscard]] const std::vector<Goal>& goals() const { return goals_; }
    /// Returns the values of a goal in the answered cases.
    [[nodiscard]] std::vector<double> values_of(const Goal& goal) const;

private:
    [[nodiscard]] Goal goal_of(const Objective& objective, std::span<const ObservableModel> learned);
    void find_references();
    std::size_t add_model(std::size_t name, std::span<const ObservableModel> learned);
    void add_objectives(Judgement& one) const;
    [[nodiscard]] std::vector<Judgement> judge_each(std::span<const ObservableModel> by,
                                                    std::span<const Setting> settings, std::size_t doubted) const;
    void add_ends(Judgement& one) const;
    [[nodiscard]] Judgement averaged(const Setting& setting, std::span<const std::size_t> sizes,
                                     std::span<const Judgement> behind) const;
    [[nodiscard]] double probability_given(const Judgement& one, std::size_t undefined) const;
    [[nodiscard]] double probability(const Judgement& one) const;

    const ModelCases* cases_;
    const WindowRequest* request_;
    StatedCondition stated_;
    WindowSpace space_;
    std::shared_ptr<const Answers> answers_;
    std::vector<std::string> names_;  ///< observables, then factors
    std::optional<Condition> condition_;
    std::vector<Goal> goals_;
    std::vector<ObservableModel> models_;
    std::vector<std::size_t> name_of_model_;
    std::optional<stats::SampledErrors> errors_;  ///< empty: there is no model
};

}  // namespace grainsweep::study
