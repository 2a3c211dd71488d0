// Columns of factors from the rows of a campaign's view.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/study/responses.hpp"

#include <vector>

namespace grainsweep::study {

/// Reader of one factor, row by row: numbers if it is continuous, else cells until all rows are read.
class FactorReader {
public:
    /// `scene`: null if this program does not have the scene.
    FactorReader(campaign::StatedFactor stated, const SceneInfo* scene);
    void add(const store::Table::Cell& cell);
    [[nodiscard]] FactorColumn take();

private:
    campaign::StatedFactor stated_;
    FactorColumn factor_;
    std::vector<store::Table::Cell> cells_;
};

/// Sets the coordinates of factors that take columns of one sample. They are the coordinates of the design's points.
/// For a setting that is not of the design they are the middle of the box of its row.
void add_joint_shares(Responses& responses);

}  // namespace grainsweep::study
