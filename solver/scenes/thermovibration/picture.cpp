#include "solver/scenes/thermovibration/picture.hpp"

#include "solver/scenes/dem_picture.hpp"

namespace grainsweep::thermovibration {

Snapshot picture(const Question& question, const coupling::Cloud& cloud) {
    Snapshot snapshot;
    if (cloud.size() > 0) {
        snapshot.positions = cloud.position;
        snapshot.vectors["velocity"] = cloud.velocity;
        snapshot.scalars["diameter"].assign(cloud.size(), 2 * question.sphere().radius());
    }
    snapshot.units = {{"velocity", "alpha/L"}, {"diameter", "L"}, {"temperature", "DT"}};
    snapshot.length_unit = "L";
    snapshot.time_unit = "L^2/alpha";
    WallSurface cavity{"cavity", {}, {}, {}};
    add_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, cavity);
    const auto plate = [&cavity](const char* name, std::size_t first) {
        const auto& corner = cavity.corners;
        return WallSurface{
            name, {corner[first], corner[first + 1], corner[first + 3], corner[first + 2]}, {{0, 1, 2}, {0, 2, 3}}, {}};
    };
    snapshot.walls = {cavity, plate("cold_wall", 0), plate("hot_wall", 4)};
    return snapshot;
}

FlowField drawn_flow(const Question& question, const flow::FaceVectors& velocity, const flow::Field* temperature) {
    const flow::Grid whole = question.grid();
    FlowField field;
    field.name = "flow";
    for (int d = 0; d < 3; ++d)
        for (int f = 1; f <= whole.cells(d) + 1; ++f)
            field.faces[static_cast<std::size_t>(d)].push_back(whole[d].face(f));
    auto& vectors = field.vectors["velocity"];
    vectors.reserve(whole.total_cells());
    const int half = question.mirrored() ? whole.cells(0) / 2 : whole.cells(0);
    for (int k = 1; k <= whole.cells(2); ++k)
        for (int j = 1; j <= whole.cells(1); ++j)
            for (int i = 1; i <= whole.cells(0); ++i) {
                const bool image = i > half;
                const int at = image ? 2 * half + 1 - i : i;
                const double u = 0.5 * (velocity[0](at, j, k) + velocity[0](at + 1, j, k));
                vectors.push_back({image ? -u : u, 0.5 * (velocity[1](at, j, k) + velocity[1](at, j + 1, k)),
                                   0.5 * (velocity[2](at, j, k) + velocity[2](at, j, k + 1))});
                if (temperature != nullptr) field.scalars["temperature"].push_back((*temperature)(at, j, k));
            }
    return field;
}

}  // namespace grainsweep::thermovibration
