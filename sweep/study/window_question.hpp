// One question about a process window: its condition, objective, models, and what they make of settings.
//
//   P(x) = E_noise [ answers(x) sum over the subsets U of the observables that can be undefined of
//          prod_{k in U} (1 - d_k(x)) prod_{k not in U} d_k(x) P(condition holds | those in U undefined) ]
//
// answers: answers.hpp; d_k: probability that observable k is defined. Under `for all` P is the least over the levels.
// A comparison with an undefined value is not true, and the condition does not hold where the objective is undefined.
// Noise and levels: window_space.hpp. Objective and responses are means over what is averaged, their errors the mean
// error (errors of one model go together), their scatter that of single runs and of the means over the noise.
#pragma once

#include "stats/process_window.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/condition.hpp"
#include "sweep/study/response_models.hpp"
#include "sweep/study/window_space.hpp"

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

struct WindowRequest {
    std::string where{};      ///< empty: holds everywhere; may end with "for all NAME"
    std::string objective{};  ///< observable or factor; empty: none, the setting where the condition is surest
    bool maximise = true;
    double risk = 0.05;
    stats::Judged judged = stats::Judged::mean;
    std::size_t next = 0;           ///< cases to run next
    std::size_t candidates = 4096;  ///< Sobol points of the box; a quarter of them where something is averaged
    Held held{};
};

/// A setting and what the models say of it.
struct Judgement {
    Setting setting;                             ///< NaN: averaged over
    std::vector<stats::Prediction> predictions;  ///< one per model
    std::vector<double> defined;                 ///< the same: probability that the observable is defined
    stats::Prediction objective{};               ///< where there is one; of a factor its value, without error
    double answers = 1;                          ///< probability that a case has an answer
    double answers_low = 1;                      ///< lower end of its 95 % interval
    bool believed = true;                        ///< an answer is likelier than none, every feature has a number
    double probability = std::numeric_limits<double>::quiet_NaN();
};

class WindowQuestion {
public:
    /// `learned`: models that are there already, and `answers`, where it is.
    WindowQuestion(const ModelCases& cases, const WindowRequest& request, Admits admits,
                   std::span<const ObservableModel> learned = {}, std::shared_ptr<const Answers> answers = nullptr);

    [[nodiscard]] std::vector<Judgement> judge(std::span<const Setting> settings) const;
    /// What the models in `by`, in the order of models(), say of settings.
    [[nodiscard]] std::vector<Judgement> judge_by(std::span<const ObservableModel> by,
                                                  std::span<const Setting> settings) const;
    /// The setting behind one where a case would teach most: the largest error of the first model, or the probability
    /// nearest to 1/2.
    [[nodiscard]] Setting least_known(std::span<const ObservableModel> by, const Setting& setting) const;

    /// Whether `a` is the better answer: the objective where the condition is met surely enough, else the probability.
    /// Settings whose answer is sure, answers_low >= 1 - risk, come before all others: where cases fail beyond a sharp
    /// border, an objective that grows towards it leads to where P has just sunk to 1 - risk, and of 20 such settings
    /// one lies beyond.
    [[nodiscard]] bool better(const Judgement& a, const Judgement& b) const;
    [[nodiscard]] bool meets(const Judgement& one) const { return one.probability >= 1 - request_->risk; }

    [[nodiscard]] const WindowSpace& space() const { return space_; }
    [[nodiscard]] const std::shared_ptr<const Answers>& answers() const { return answers_; }
    [[nodiscard]] const std::optional<Condition>& condition() const { return condition_; }
    [[nodiscard]] const std::vector<ObservableModel>& models() const { return models_; }
    [[nodiscard]] std::size_t name_of_model(std::size_t model) const { return name_of_model_[model]; }
    [[nodiscard]] bool objective_is_factor() const { return factor_.has_value(); }
    /// The objective is an observable: that of the first model.
    [[nodiscard]] bool modelled_objective() const { return !request_->objective.empty() && !factor_; }

private:
    void find_objective(std::span<const ObservableModel> learned);
    void add_model(std::size_t name, std::span<const ObservableModel> learned);
    [[nodiscard]] std::vector<Judgement> judge_each(std::span<const ObservableModel> by,
                                                    std::span<const Setting> settings) const;
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
    std::optional<std::size_t> factor_;  ///< the objective, where it is one
    std::vector<ObservableModel> models_;
    std::vector<std::size_t> name_of_model_;
    std::optional<stats::SampledErrors> errors_;  ///< none: there is no model
};

}  // namespace grainsweep::study
