#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace grainsweep::campaign {

namespace {

designs::PointSet sample(const Campaign& campaign) {
    const auto* design = designs::find_design(campaign.design);
    if (design == nullptr) throw wrong_question("$.design.kind", campaign.design, "there is no such design");
    designs::PointSet points;
    try {
        points = design->sample(campaign.request);
    } catch (const std::invalid_argument& error) {
        throw wrong_question("$.design", "", error.what());
    }
    if (points.size() == 0) throw wrong_question("$.design", "", "the design has no point");
    if (points.size() > static_cast<std::size_t>(most_cases / campaign.replicates))
        throw wrong_question("$.design", fmt::format("{} points x {} replicates", points.size(), campaign.replicates),
                             fmt::format("a campaign has at most {} cases", most_cases));
    return points;
}

/// A scene and its defaults, looked up once for many cases.
class CaseMaker {
public:
    explicit CaseMaker(const SceneInfo& scene) : scene_(scene), defaults_(scene.defaults()) {}

    [[nodiscard]] Inputs completed(const Inputs& given) const {
        Inputs inputs = defaults_;
        for (const auto& [name, value] : given) {
            const auto slot = inputs.find(name);
            if (slot == inputs.end()) {
                throw WrongQuestion(fmt::format("scene '{}' has no parameter '{}'.", scene_.name, name));
            }
            slot->second = coerced(value, slot->second);
        }
        return inputs;
    }
    [[nodiscard]] std::string text(const Inputs& inputs, std::optional<std::uint64_t> seed) const {
        return canonical_text(scene_.name, scene_.revision, inputs, defaults_, seed);
    }
    [[nodiscard]] Case make(Inputs inputs, std::uint64_t seed) const {
        std::string id = content_hash(text(inputs, seed));
        return {std::move(id), scene_.name, scene_.revision, std::move(inputs), seed};
    }

private:
    const SceneInfo& scene_;
    Inputs defaults_;
};

}  // namespace

std::int64_t candidates_of(const Campaign& campaign) {
    return designs::design_named(campaign.design).size(campaign.request);
}

std::int64_t least_block(std::string_view rule, std::int64_t sequences) {
    constexpr std::int64_t fewest = 4;
    return rule == "replicates" ? fewest * sequences : fewest;
}

std::int64_t default_block(std::int64_t points, std::int64_t sequences, std::int64_t least) {
    const std::int64_t part = std::min(points / checks_by_default, longest_default_block);
    return std::max(least, part - part % sequences);
}

std::string never_converges(const Campaign& campaign) {
    if (!campaign.convergence) return {};
    const std::int64_t points = candidates_of(campaign);
    const auto& [observable, rule, gates, tolerance, block, stop] = *campaign.convergence;
    if (block > points)
        return fmt::format("convergence can never be checked: a block is {} points, and the design has {}", block,
                           points);
    if (2 * block > points)
        return fmt::format(
            "convergence can never be found: the rule '{}' needs two checks, and with a block of {} the {} points of "
            "the design give one",
            rule, block, points);
    return {};
}

void check_design(const Campaign& campaign) {
    (void)sample(campaign);
}

std::vector<PlacedCase> unfold(const Campaign& campaign, const Filter& filter) {
    const designs::PointSet points = sample(campaign);
    const CaseMaker maker(campaign.scene());
    const std::size_t sequences = std::max<std::size_t>(points.sequences, 1);
    std::vector<PlacedCase> cases;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Inputs inputs =
            points.rows.empty() ? campaign.space.at(points.point(p)) : campaign.space.at(points.rows[p]);
        if (filter && !filter(inputs)) continue;
        const std::string asked = maker.text(inputs, std::nullopt);
        for (std::int64_t replicate = 0; replicate < campaign.replicates; ++replicate) {
            cases.push_back({maker.make(inputs, case_seed(campaign.seed, asked, replicate)),
                             static_cast<std::int64_t>(p), static_cast<std::int64_t>(p % sequences), replicate});
        }
    }
    if (cases.empty()) {
        throw wrong_question("$.where", fmt::format("\"{}\"", campaign.where),
                             fmt::format("it leaves none of the {} points of the design", points.size()));
    }
    return cases;
}

Case make_case(const SceneInfo& scene, const Inputs& inputs, std::uint64_t seed) {
    const CaseMaker maker(scene);
    return maker.make(maker.completed(inputs), seed);
}

std::uint64_t case_seed(const Campaign& campaign, const Inputs& inputs, std::int64_t replicate) {
    const CaseMaker maker(campaign.scene());
    return case_seed(campaign.seed, maker.text(maker.completed(inputs), std::nullopt), replicate);
}

}  // namespace grainsweep::campaign
