// Header and blocks of a film.
#include "sweep/report/film.hpp"
#include "sweep/report/packed_column.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace grainsweep::report {
/// Range of the colours of a column.
struct ValueRange {
    double low = 0, high = 0;
    bool clipped = false;  ///< a few values lie beyond
};

namespace {

constexpr double finest = 65535;
constexpr double colours = 254;           // levels of a colour that is defined
constexpr double common_share = 0.995;    // quantile of the values; values beyond it are rare
constexpr double far_beyond = 1.5;        // times that quantile
constexpr std::size_t sampled = 200'000;  // values that determine a quantile
constexpr double bytes_per_sphere = 8.3;  // and frame, as text

/// From the values that are numbers: from 0, or around 0, or from the least where all are far from 0 and differ.
ValueRange range_of(std::vector<float> values) {
    std::erase_if(values, [](float x) { return !std::isfinite(x); });
    if (values.empty()) return {};
    const auto [least, most] = std::ranges::minmax(values);
    ValueRange range{least, most, false};
    for (float& x : values) x = std::abs(x);
    const auto rank =
        values.begin() + static_cast<std::ptrdiff_t>(std::ceil(common_share * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), rank, values.end());
    const double common = *rank;
    const double largest = std::max(std::abs(range.low), range.high);
    const bool clipped = common > 0 && largest > far_beyond * common;
    const double end = clipped ? common : largest;
    if (range.low < 0) return {-end, end, clipped};
    if (range.low < 0.5 * end || range.low == end) range.low = 0;
    return {range.low, end, clipped};
}

std::uint16_t colour_of(double x, const ValueRange& range) {
    if (!std::isfinite(x)) return 0;
    const double width = range.high - range.low;
    const double share = width > 0 ? std::clamp((x - range.low) / width, 0.0, 1.0) : 0.0;
    return static_cast<std::uint16_t>(1 + std::lround(colours * share));
}

}  // namespace

/// Writes the blocks one after the other and their lengths into the header.
class FilmWriter {
public:
    FilmWriter(const Film& film, const Json& about)
        : film_(film),
          header_{{"about", about},
                  {"time_unit", film.time_unit_},
                  {"length_unit", film.length_unit_},
                  {"times", film.times_},
                  {"periods", film.periods_},
                  {"spheres", film.spheres_.size()},
                  {"particles", film.most_present_}} {}  // more than spheres: thinned

    std::string write() {
        if (!film_.spheres_.empty()) {
            write_positions();
            write_traits();
        }
        write_walls();
        write_slices();
        write_forces();
        write_columns();
        header_.add("blocks", lengths_);
        const std::string& header = header_.text();
        std::string bytes = "GSF2";
        for (unsigned shift = 0; shift < 32; shift += 8)
            bytes.push_back(static_cast<char>(header.size() >> shift & 0xFFU));
        return bytes + header + blocks_;
    }

private:
    using Numbers = std::vector<std::uint16_t>;

    /// Returns the number of the block.
    std::size_t block(const Numbers& values, std::size_t items) { return block(pack_film_column(values, items)); }
    std::size_t block(const std::string& bytes) {
        blocks_ += bytes;
        lengths_.push_back(bytes.size());
        return lengths_.size() - 1;
    }

    /// Writes three columns, one after the other in each frame. An absent particle keeps its last position.
    void write_positions() {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        std::array<double, 3> low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite}, step{};
        for (const auto& frame : film_.frames_)
            for (const auto& x : frame.positions)
                for (std::size_t a = 0; a < 3; ++a) {
                    if (!std::isfinite(x[a])) continue;
                    low[a] = std::min<double>(low[a], x[a]);
                    high[a] = std::max<double>(high[a], x[a]);
                }
        for (std::size_t a = 0; a < 3; ++a) {
            if (!(low[a] <= high[a])) low[a] = high[a] = 0;
            step[a] = (high[a] - low[a]) / finest;
        }
        const std::size_t n = film_.spheres_.size();
        Numbers places(3 * n * film_.frames_.size()), present(n * film_.frames_.size());
        bool all_present = true;
        for (std::size_t f = 0; f < film_.frames_.size(); ++f) {
            const auto& now = film_.frames_[f].positions;
            for (std::size_t i = 0; i < n; ++i) {
                const bool there = i < now.size() && std::isfinite(now[i][0] + now[i][1] + now[i][2]);
                present[f * n + i] = there ? 1 : 0;
                all_present = all_present && there;
                for (std::size_t a = 0; a < 3; ++a) {
                    auto& place = places[(3 * f + a) * n + i];
                    if (there)
                        place = step[a] > 0 ? static_cast<std::uint16_t>(std::lround((now[i][a] - low[a]) / step[a]))
                                            : std::uint16_t{0};
                    else if (f > 0)
                        place = places[(3 * (f - 1) + a) * n + i];
                }
            }
        }
        header_.add("positions", {{"low", low}, {"step", step}, {"block", block(places, 3 * n)}});
        if (!all_present) header_.add("present", block(present, n));
    }

    /// Writes the contacts of all frames one after the other: place of the first sphere, difference to that of the
    /// second, force. Forces lie between 0 and the largest, or the quantile where a few are far larger; attraction is
    /// negative.
    void write_forces() {
        if (!film_.shows_forces()) return;
        Numbers first, between, shades;
        std::vector<std::size_t> counts;
        std::vector<float> sizes;
        for (const auto& frame : film_.frames_)
            for (const auto& one : frame.forces) sizes.push_back(static_cast<float>(one.size));
        ValueRange range = range_of(std::move(sizes));
        range.low = std::min(range.low, 0.0);
        for (const auto& frame : film_.frames_) {
            counts.push_back(frame.forces.size());
            for (const auto& one : frame.forces) {
                first.push_back(static_cast<std::uint16_t>(one.first));
                between.push_back(static_cast<std::uint16_t>(one.second - one.first));
                shades.push_back(colour_of(one.size, range));
            }
        }
        const auto all = std::max<std::size_t>(first.size(), 1);
        header_.add("forces", {{"counts", counts},
                               {"low", range.low},
                               {"high", range.high},
                               {"clipped", range.clipped},
                               {"first", block(first, all)},
                               {"between", block(between, all)},
                               {"shades", block(shades, all)}});
    }

    /// Diameters as 16-bit numbers over their largest (0: the scene names none); which spheres are mobile.
    void write_traits() {
        double largest = 0;
        bool all_mobile = true;
        for (const auto& sphere : film_.spheres_) {
            if (std::isfinite(sphere.diameter)) largest = std::max(largest, sphere.diameter);
            all_mobile = all_mobile && sphere.mobile;
        }
        Numbers diameters, mobile;
        bool equal = true;
        for (const auto& sphere : film_.spheres_) {
            const double share = largest == 0 ? 1 : std::isfinite(sphere.diameter) ? sphere.diameter / largest : 0;
            diameters.push_back(static_cast<std::uint16_t>(std::lround(finest * std::clamp(share, 0.0, 1.0))));
            equal = equal && diameters.back() == diameters.front();
            mobile.push_back(sphere.mobile ? 1 : 0);
        }
        header_.add("diameter",
                    {{"largest", largest}, {"equal", equal}, {"block", block(diameters, diameters.size())}});
        if (!all_mobile) header_.add("mobile", block(mobile, mobile.size()));
    }

    /// Writes the columns for the colours of mobile spheres; values of frozen spheres would hide the state of the
    /// powder. Velocity comes first, then the smallest columns, so that as many as possible fit.
    void write_columns() {
        const std::size_t n = film_.spheres_.size();
        const double text = 4.0 / 3;  // base64
        const double most = std::max(static_cast<double>(film_.limits_.bytes),
                                     bytes_per_sphere * static_cast<double>(n * film_.frames_.size())) /
                            text;
        struct Column {
            std::string name, bytes;
            ValueRange range;
        };
        std::vector<Column> columns;
        for (const auto& name : column_names()) {
            const ValueRange range = range_of(sample_of(name));
            columns.push_back({name, pack_film_column(shades_of(name, range), n), range});
        }
        std::stable_sort(columns.begin() + (columns.empty() ? 0 : 1), columns.end(),
                         [](const auto& a, const auto& b) { return a.bytes.size() < b.bytes.size(); });
        Json kept = Json::array(), left_out = Json::array();
        for (const auto& [name, bytes, range] : columns) {
            if (static_cast<double>(blocks_.size() + bytes.size()) + header_room > most)
                left_out.push_back(name);
            else
                kept.push_back(coloured(name, range).add("block", block(bytes)));
        }
        header_.add("columns", kept).add("left_out", left_out);
    }

    [[nodiscard]] Numbers shades_of(const std::string& name, const ValueRange& range) const {
        const std::size_t n = film_.spheres_.size();
        Numbers values(n * film_.frames_.size());
        for (std::size_t f = 0; f < film_.frames_.size(); ++f) {
            const auto found = film_.frames_[f].columns.find(name);
            if (found == film_.frames_[f].columns.end()) continue;
            for (std::size_t i = 0; i < found->second.size(); ++i)
                if (film_.spheres_[i].mobile) values[f * n + i] = colour_of(found->second[i], range);
        }
        return values;
    }

    /// Velocity first, then by name.
    [[nodiscard]] std::vector<std::string> column_names() const {
        std::set<std::string> names;
        for (const auto& frame : film_.frames_)
            for (const auto& [name, values] : frame.columns) names.insert(name);
        std::vector<std::string> ordered(names.begin(), names.end());
        std::ranges::stable_partition(ordered, [](const std::string& name) { return name == "velocity"; });
        return ordered;
    }

    /// Of the mobile spheres, every k-th one.
    [[nodiscard]] std::vector<float> sample_of(const std::string& name) const {
        const std::size_t every = 1 + film_.spheres_.size() * film_.frames_.size() / sampled;
        std::vector<float> sample;
        std::size_t count = 0;
        for (const auto& frame : film_.frames_) {
            const auto found = frame.columns.find(name);
            if (found == frame.columns.end()) continue;
            for (std::size_t i = 0; i < found->second.size(); ++i)
                if (film_.spheres_[i].mobile && count++ % every == 0) sample.push_back(found->second[i]);
        }
        return sample;
    }

    [[nodiscard]] Json coloured(const std::string& name, const ValueRange& range) const {
        const auto unit = film_.units_.find(name);
        return {{"name", name},
                {"unit", unit == film_.units_.end() ? "" : unit->second},
                {"low", range.low},
                {"high", range.high},
                {"clipped", range.clipped}};
    }

    /// Writes corners as 16-bit numbers in the wall's own box: one frame for a fixed wall, else the `frames` frames
    /// from `first` on that show the wall.
    void write_walls() {
        Json walls = Json::array(), left_out = Json::array();
        for (const auto& wall : film_.walls_) {
            const std::size_t n = wall.shape.corners.size();
            if (n > static_cast<std::size_t>(finest)) {
                left_out.push_back(wall.shape.name);
                continue;
            }
            std::array<double, 3> low = wall.shape.corners.front(), high = low, step{};
            for (const auto& corners : wall.corners)
                for (const auto& x : corners)
                    for (std::size_t a = 0; a < 3; ++a) {
                        low[a] = std::min(low[a], x[a]);
                        high[a] = std::max(high[a], x[a]);
                    }
            for (std::size_t a = 0; a < 3; ++a) step[a] = (high[a] - low[a]) / finest;
            Numbers places;
            for (std::size_t f = 0; f < (wall.moves ? wall.corners.size() : 1); ++f)
                for (std::size_t a = 0; a < 3; ++a)
                    for (const auto& x : wall.corners[f])
                        places.push_back(step[a] > 0
                                             ? static_cast<std::uint16_t>(std::lround((x[a] - low[a]) / step[a]))
                                             : std::uint16_t{0});
            walls.push_back({{"name", wall.shape.name},
                             {"first", wall.first},
                             {"frames", wall.corners.size()},
                             {"moves", wall.moves},
                             {"corners", n},
                             {"low", low},
                             {"step", step},
                             {"places", block(places, 3 * n)},
                             {"triangles", cells_of(wall.shape.triangles)},
                             {"edges", cells_of(wall.shape.edges)}});
        }
        header_.add("walls", walls);
        if (!left_out.empty()) header_.add("walls_left_out", left_out);
    }

    /// The corners of each cell, as a frame of the column.
    template <std::size_t Corners>
    std::size_t cells_of(const std::vector<std::array<std::int32_t, Corners>>& cells) {
        Numbers indices;
        for (const auto& cell : cells)
            for (const auto corner : cell) indices.push_back(static_cast<std::uint16_t>(corner));
        return block(indices, Corners);
    }

    /// planes[a]: across axis a; the other two axes in their order, the first of them fastest.
    void write_slices() {
        Json slices = Json::array();
        for (const auto& slice : film_.slices_) {
            if (slice.frames < film_.times_.size()) continue;
            std::vector<float> all;
            for (const auto& plane : slice.planes) all.insert(all.end(), plane.begin(), plane.end());
            const ValueRange range = range_of(std::move(all));
            Json planes = Json::array();
            for (const auto& plane : slice.planes) {
                Numbers values;
                for (const float x : plane) values.push_back(colour_of(x, range));
                planes.push_back(block(values, plane.size() / slice.frames));
            }
            slices.push_back(coloured(slice.quantity, range)
                                 .add({{"component", slice.component},
                                       {"field", slice.field},
                                       {"faces", slice.faces},
                                       {"planes", planes}}));
        }
        header_.add("slices", slices);
    }

    static constexpr double header_room = 20'000;  // bytes

    const Film& film_;
    Json header_;
    std::vector<std::size_t> lengths_;  // of the blocks, bytes
    std::string blocks_;
};

std::string Film::bytes(const Json& about) const {
    return FilmWriter(*this, about).write();
}

}  // namespace grainsweep::report
