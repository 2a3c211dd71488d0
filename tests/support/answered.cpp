#include "tests/support/answered.hpp"

#include "sweep/campaign/reader.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/when_clauses.hpp"

#include <algorithm>
#include <set>

namespace grainsweep::tests {

campaign::Campaign answer_by(store::Store& store, const std::string& text, const Formula& formula, std::size_t cases,
                             const std::function<bool(const campaign::PlacedCase&)>& wanted) {
    const Formulas all = [&](const Inputs& inputs) -> std::optional<std::map<std::string, double>> {
        const auto y = formula(inputs);
        if (!y) return std::nullopt;
        return std::map<std::string, double>{{"y", *y}};
    };
    return answer_all_by(store, text, all, cases, wanted);
}

campaign::Campaign answer_all_by(store::Store& store, const std::string& text, const Formulas& formulas,
                                 std::size_t cases, const std::function<bool(const campaign::PlacedCase&)>& wanted) {
    auto campaign = campaign::parse_campaign(text, std::filesystem::temp_directory_path());
    campaign.space.when = store::when_clauses(campaign.space);
    const auto placed =
        campaign::unfold(campaign, store::make_filter(campaign.where, campaign::filter_names(campaign)));
    const auto states = store.enrol(campaign, placed, here());
    store.group([&] {
        std::set<campaign::CaseId> settled;
        for (std::size_t i = 0; i < std::min(cases, placed.size()); ++i) {
            const auto& question = placed[i].question;
            if (wanted && !wanted(placed[i])) continue;
            const bool known = states[i].outcome && settles(*states[i].outcome);
            if (known || !settled.insert(question.id).second) continue;
            campaign::CaseResult result;
            result.attempt = {question.id, states[i].attempts + 1};
            if (const auto all = formulas(question.inputs)) {
                for (const auto& [name, y] : *all) result.observations.scalars[name] = y;
            } else {
                result.outcome = campaign::Outcome::unstable;
                result.message = "the formula has no answer";
            }
            store.begin(result.attempt);
            store.finish(result);
        }
    });
    return campaign;
}

double input(const Inputs& inputs, std::string_view name) {
    return std::get<double>(inputs.find(name)->second);
}

}  // namespace grainsweep::tests
