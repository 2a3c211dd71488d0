#include "sweep/study/curves.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace grainsweep::study {
namespace {

struct Sampled {
    double time, bin, value;
};

using Series = std::map<std::string, std::vector<Sampled>, std::less<>>;

Series series_of(const store::Store& store, const std::string& case_id) {
    Series all;
    // Reads the tables, because a database may have another view named `series`.
    const auto table = store.query(
        fmt::format("SELECT b.name, o.time, o.bin, o.value FROM sim_case AS c "
                    "JOIN observable AS b ON b.scene = c.scene AND b.revision = c.revision AND b.shape <> 'scalar' "
                    "JOIN observation AS o ON o.case_key = c.case_key AND o.observable_id = b.observable_id "
                    "WHERE c.case_id = '{}' ORDER BY 1, 2, 3",
                    case_id));
    for (const auto& row : table.rows)
        all[std::get<std::string>(row[0])].push_back({number_of(row[1]), number_of(row[2]), number_of(row[3])});
    return all;
}

/// Of a histogram taken at several times: the time a quarter of the way.
double time_to_show(std::span<const Sampled> samples) {
    std::vector<double> times;
    for (const auto& sample : samples)
        if (times.empty() || sample.time != times.back()) times.push_back(sample.time);
    return times[times.size() / 4];
}

/// The samples of one curve in order, evenly thinned; the first and the last stay.
Curve thinned(std::vector<std::pair<double, double>> samples, std::size_t most) {
    Curve curve;
    const std::size_t n = samples.size(), kept = std::min(n, most);
    for (std::size_t k = 0; k < kept; ++k) {
        const auto& [x, y] = samples[kept < 2 ? 0 : k * (n - 1) / (kept - 1)];
        curve.x.push_back(x);
        curve.y.push_back(y);
    }
    return curve;
}

void add(CurveFamily& family, std::size_t row, const std::string& label, std::span<const Sampled> samples,
         std::size_t most) {
    const bool has_bins = std::isfinite(samples.front().bin), has_times = std::isfinite(samples.front().time);
    family.over_bins = has_bins;
    if (has_bins && has_times && std::isnan(family.at_time)) family.at_time = time_to_show(samples);
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& sample : samples)
        if (std::abs(sample.time - family.at_time) < std::abs(nearest - family.at_time)) nearest = sample.time;
    std::vector<std::pair<double, double>> points;
    for (const auto& sample : samples)
        if (!has_bins || !has_times || sample.time == nearest)
            points.emplace_back(has_bins ? sample.bin : sample.time, sample.value);
    Curve curve = thinned(std::move(points), most);
    curve.row = row;
    curve.label = label;
    family.curves.push_back(std::move(curve));
}

std::string label_of(const Responses& responses, std::size_t row) {
    std::string label;
    for (const auto& factor : responses.factors) label += (label.empty() ? "" : ", ") + factor_text(factor, row);
    return label;
}

}  // namespace

Curves read_curves(const store::Store& store, const Responses& responses, const CurveChoice& choice) {
    Curves curves;
    const auto scene = find_scene(responses.campaign.scene);
    if (scene == nullptr) return curves;
    for (const auto& spec : scene->observables)
        if (spec.shape != Shape::scalar) {
            CurveFamily& family = curves.families.emplace_back();
            family.name = spec.name;
            family.unit = spec.unit;
            family.meaning = spec.meaning;
            family.over = spec.over;
        }
    std::vector<std::size_t> completed;
    for (std::size_t row = 0; row < responses.rows(); ++row)
        if (responses.outcomes[row] == campaign::Outcome::completed) completed.push_back(row);
    curves.completed = completed.size();
    if (curves.families.empty()) return curves;
    const auto rows = random_rows(std::move(completed), choice.most_curves);
    curves.drawn = rows.size();
    for (const auto row : rows) {
        const Series series = series_of(store, responses.case_ids[row]);
        for (auto& family : curves.families) {
            const auto found = series.find(family.name);
            if (found != series.end()) add(family, row, label_of(responses, row), found->second, choice.most_samples);
        }
    }
    std::erase_if(curves.families, [](const CurveFamily& family) { return family.curves.empty(); });
    return curves;
}

}  // namespace grainsweep::study
