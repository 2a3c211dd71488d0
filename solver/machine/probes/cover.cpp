// View of a camera along the axis of a drum with light behind it: the cells whose centres a particle hides. Area, angle
// and outline are computed from the mean image of all frames so far.
#include "solver/machine/probe.hpp"
#include "solver/machine/probes/section.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace grainsweep::machine::probes {
namespace {

constexpr double most_image_cells = 1e6;
constexpr double half_of_the_time = 0.5;

/// Cells whose centres lie in the drum.
std::vector<std::size_t> cells_in_drum(const observables::SectionGrid& grid, double radius) {
    std::vector<std::size_t> cells;
    for (std::int64_t row = 0; row < grid.count; ++row)
        for (std::int64_t column = 0; column < grid.count; ++column)
            if (std::hypot(grid.centre(column), grid.centre(row)) <= radius) cells.push_back(grid.number(column, row));
    return cells;
}

/// The image of one frame; its mean is the share of the frames in which a cell is hidden.
class CoverImage final : public machine::Probe {
public:
    explicit CoverImage(const Options& options)
        : look_(options, true),
          cover_(options.number("radius"), options.number("cell")),
          cells_(cells_in_drum(cover_.grid(), options.number("radius"))) {}
    double look(const Frame&) override { return undefined; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        const auto section = look_(frame);
        if (!section) return;
        const auto hidden = cover_.hidden_by(*section);
        into.reserve(cells_.size());
        for (const std::size_t cell : cells_)
            into.push_back({.bin = static_cast<double>(cell), .value = static_cast<double>(hidden[cell])});
    }

private:
    SectionLook look_;
    observables::Cover cover_;
    std::vector<std::size_t> cells_;
};

enum class OfCover { area, angle, outline };

template <OfCover of>
class CoverProbe final : public machine::Probe {
public:
    explicit CoverProbe(const Options& options)
        : look_(options, true),
          radius_(options.number("radius")),
          reach_(options.number("reach", 1)),
          cover_(radius_, options.number("cell")),
          cells_(cells_in_drum(cover_.grid(), radius_)) {}

    double look(const Frame& frame) override {
        add(frame);
        if (of == OfCover::outline) return undefined;
        const auto share = cover_.share();
        if (of == OfCover::angle)
            return std::atan(0 - observables::fitted_line(outline(share)).slope) * 180 / std::numbers::pi;
        const auto hidden =
            std::ranges::count_if(cells_, [&](std::size_t cell) { return share[cell] >= half_of_the_time; });
        return static_cast<double>(hidden) * cover_.grid().cell * cover_.grid().cell;
    }

    void profile(const Frame& frame, std::vector<Sample>& into) override {
        if (of != OfCover::outline) return;
        add(frame);
        const auto points = outline(cover_.share());
        auto point = points.begin();
        const auto& grid = cover_.grid();
        // A bin of its own for each column, so that frames can be compared bin by bin.
        for (std::int64_t k = 0; k < grid.count; ++k) {
            const double x = grid.centre(k);
            if (std::abs(x) > reach_ * radius_) continue;
            const bool here = point != points.end() && (*point)[0] == x;
            into.push_back({.bin = x, .value = here ? (*point)[1] : undefined});
            if (here) ++point;
        }
    }

    void save(ByteWriter& out) const override {
        once_.save(out);
        save_sum(cover_, out);
    }
    void restore(ByteReader& in) override {
        once_.restore(in);
        restore_sum(cover_, in);
    }

private:
    void add(const Frame& frame) {
        if (!once_(frame)) return;
        if (const auto section = look_(frame)) cover_.add(*section);
    }
    [[nodiscard]] std::vector<std::array<double, 2>> outline(const std::vector<double>& share) const {
        return observables::falling_through(cover_.grid(), share, half_of_the_time, reach_ * radius_);
    }

    SectionLook look_;
    double radius_, reach_;
    FramesOnce once_;
    observables::Cover cover_;
    std::vector<std::size_t> cells_;
};

std::string flaw_of_cover(const Options& given) {
    const double columns = 2 * std::ceil(given.number("radius") / given.number("cell") - 1e-9);
    return columns * columns <= most_image_cells ? "" : "\"cell\" makes more than 1000 by 1000 cells";
}

constexpr Field cell_option =
    option("cell", Field::Kind::quantity, "m", "side of the cells", true, {0, 1e3, true, false});
constexpr std::array cover_options = {
    of_option, in_option, section_axis_option, section_through_option, section_radius_option, cell_option};
constexpr std::array outline_options = {
    of_option,
    in_option,
    section_axis_option,
    section_through_option,
    section_radius_option,
    cell_option,
    option("reach", Field::Kind::quantity, "1", "farthest column from the axis, as a share of the radius; default: 1",
           false, {0, 1, true, false})};

}  // namespace

ProbeInfo cover() {
    return probe_row<CoverImage>(
        "cover", "1", "1 for each cell across a drum whose centre a particle hides from a view along the axis, else 0",
        cover_options,
        {.over = "cell: column + columns times row, columns = 2 ceil(radius/cell)", .flaw = flaw_of_cover});
}
ProbeInfo cover_angle() {
    return probe_row<CoverProbe<OfCover::angle>>("cover_angle", "deg",
                                                 "slope of the line through the heights of cover_outline",
                                                 outline_options, {.flaw = flaw_of_cover});
}
ProbeInfo cover_area() {
    return probe_row<CoverProbe<OfCover::area>>(
        "cover_area", "m2", "area of the cells of cover that are hidden in at least half of the frames so far",
        cover_options, {.flaw = flaw_of_cover});
}
ProbeInfo cover_outline() {
    return probe_row<CoverProbe<OfCover::outline>>(
        "cover_outline", "m",
        "height above the axis at which the mean of cover over the frames so far falls through 0.5, column by column",
        outline_options, {.over = "distance across the axis, m", .flaw = flaw_of_cover});
}

}  // namespace grainsweep::machine::probes
