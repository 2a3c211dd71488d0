// Columns of factors from the rows of a campaign's view.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/study/responses.hpp"

#include <vector>

namespace grainsweep::study {

/// A factor as its rows come by: numbers where it is continuous, else cells until all are known.
class FactorReader {
public:
    /// `scene`: null where this program does not have it.
    FactorReader(campaign::StatedFactor stated, const SceneInfo* scene);
    void add(const store::Table::Cell& cell);
    [[nodiscard]] FactorColumn take();

private:
    campaign::StatedFactor stated_;
    FactorColumn factor_;
    std::vector<store::Table::Cell> cells_;
};

/// Gives factors that take columns of one sample their coordinates: those of the design's points, and of settings that
/// no design made the middle of the box of their row.
void add_joint_shares(Responses& responses);

}  // namespace grainsweep::study
