#include "sweep/cli/run_campaign_judge.hpp"

#include "sweep/store/expression.hpp"
#include "sweep/study/model_view.hpp"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace grainsweep::cli {

std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                            const campaign::Cases& placed, std::int64_t candidates) {
    if (!campaign.convergence) return nullptr;
    const auto stored = store.values(campaign.name, campaign.convergence->observable);
    std::vector<double> known(placed.size(), std::numeric_limits<double>::quiet_NaN());
    auto next = stored.begin();  // both are ordered by point, then replicate
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const auto here = std::pair(std::int64_t{placed.place(i).point}, std::int64_t{placed.place(i).replicate});
        while (next != stored.end() && std::pair(next->point, next->replicate) < here) ++next;
        if (next == stored.end() || std::pair(next->point, next->replicate) != here) continue;
        if (next->outcome) known[i] = next->value;
    }
    const auto sequences = static_cast<std::size_t>(designs::independent_sequences(campaign.design, campaign.request));
    std::optional<schedule::ModelView> view;
    if (campaign.convergence->traits().of_model)
        view = study::model_view(campaign, candidates,
                                 store::make_filter(campaign.where, campaign::filter_names(campaign)));
    const bool weigh = campaign::repeats_weigh(campaign.space.factors);
    return std::make_unique<schedule::Judge>(*campaign.convergence, placed, sequences, std::move(known), candidates,
                                             std::move(view), weigh);
}

}  // namespace grainsweep::cli
