#include "tests/support/scene_corners.hpp"

#include "sweep/campaign/campaign.hpp"
#include "sweep/workers/compute.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace grainsweep::tests {

void expect_bounds_are_made_or_refused(const SceneInfo& scene) {
    for (const auto& p : scene.parameters) {
        const auto* interval = std::get_if<Interval>(&p.bounds);
        EXPECT_FALSE(p.meaning.empty());
        for (const auto& r : p.relevant_if) EXPECT_NE(scene.find_parameter(r.other), nullptr) << p.name;
        if (interval == nullptr) continue;
        for (const double end : {interval->low + (interval->low_open ? 1e-6 : 0.0), interval->high}) {
            Inputs inputs = scene.defaults();
            if (std::holds_alternative<double>(p.default_value))
                inputs[p.name] = end;
            else
                inputs[p.name] = static_cast<std::int64_t>(end);
            try {
                EXPECT_GT(scene.estimate_cost(inputs, {}).seconds, 0) << p.name << " " << end;
                for (const auto& warning : scene.warnings(inputs, {})) EXPECT_GT(warning.sentence.size(), 20U);
            } catch (const std::invalid_argument& sentence) {
                EXPECT_GT(std::string(sentence.what()).size(), 20U) << p.name;
            }
        }
    }
}

std::map<campaign::Outcome, int> outcomes_of(const SceneInfo& scene, const Inputs& inputs,
                                             const std::vector<Changes>& table) {
    std::map<campaign::Outcome, int> outcomes;
    for (const auto& changes : table) {
        Inputs asked = inputs;
        std::string what;
        for (const auto& [name, value] : changes) {
            asked.at(name) = value;
            what += std::string(" ") + name;
            if (const auto* x = std::get_if<double>(&value)) what += "=" + std::to_string(*x);
        }
        SCOPED_TRACE(what);
        NoArtefacts none;
        const auto result = workers::compute(campaign::make_case(scene, asked, 9), 1, none, std::nullopt,
                                             [](const Scene&) { return true; });
        if (!result) {
            ADD_FAILURE() << "given up";
            continue;
        }
        ++outcomes[result->outcome];
        if (result->outcome != campaign::Outcome::completed) {
            EXPECT_TRUE(result->outcome == campaign::Outcome::unstable ||
                        result->outcome == campaign::Outcome::rejected);
            EXPECT_GT(result->message.size(), 20U);
            EXPECT_EQ(result->message.find("nan"), std::string::npos) << result->message;
            continue;
        }
        for (const auto& [name, value] : result->observations.scalars) EXPECT_TRUE(std::isfinite(value)) << name;
        for (const auto& [name, samples] : result->observations.series)
            for (const auto& sample : samples) EXPECT_FALSE(std::isinf(sample.value)) << name;
    }
    return outcomes;
}

}  // namespace grainsweep::tests
