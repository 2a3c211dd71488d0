#include "tests/support/trade_off.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <stdexcept>

namespace grainsweep::tests {

namespace {

double seen_error(const Setting& s) {
    return std::max({std::abs(s.error), s.uncertainty, 1e-16});
}

struct Axis {
    double low = 0, high = 1, from = 0, to = 1;  ///< decades, pixels
    [[nodiscard]] double at(double value) const {
        return from + (std::log10(value) - low) / (high - low) * (to - from);
    }
};

Axis axis_over(const std::vector<double>& values, double from, double to) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    Axis a{std::floor(std::log10(*least)), std::ceil(std::log10(*most)), from, to};
    if (a.high <= a.low) a.high = a.low + 1;
    return a;
}

constexpr double panel_width = 460, panel_height = 340;
constexpr std::size_t most_names = 20;  // in a panel of more settings only those no other beats are named
constexpr double left = 62, right = 14, top = 34, bottom = 46;

std::string panel(const std::vector<Setting>& settings, double x0, double y0) {
    std::vector<double> costs, errors;
    for (const auto& s : settings)
        if (!s.is_reference && !s.unstable) costs.push_back(s.cost), errors.push_back(seen_error(s));
    if (costs.empty()) return {};
    const Axis x = axis_over(costs, x0 + left, x0 + panel_width - right);
    const Axis y = axis_over(errors, y0 + panel_height - bottom, y0 + top);
    std::string out = fmt::format("<text x='{:.0f}' y='{:.0f}' font-weight='bold'>{}: error of {}</text>\n", x0 + left,
                                  y0 + 20, settings[0].scene, settings[0].measured);
    for (double d = x.low; d <= x.high; ++d)
        out += fmt::format(
            "<line x1='{0:.1f}' x2='{0:.1f}' y1='{1:.1f}' y2='{2:.1f}' stroke='#ddd'/>"
            "<text x='{0:.1f}' y='{3:.1f}' text-anchor='middle'>1e{4:.0f}</text>\n",
            x.at(std::pow(10, d)), y.from, y.to, y.from + 16, d);
    for (double d = y.low; d <= y.high; ++d)
        out += fmt::format(
            "<line x1='{0:.1f}' x2='{1:.1f}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/>"
            "<text x='{3:.1f}' y='{4:.1f}' text-anchor='end'>1e{5:.0f}</text>\n",
            x.from, x.to, y.at(std::pow(10, d)), x.from - 6, y.at(std::pow(10, d)) + 4, d);
    out += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>processor seconds</text>\n",
                       0.5 * (x.from + x.to), y0 + panel_height - 10);
    std::vector<Setting> best;
    for (const auto& s : settings)
        if (!s.dominated && !s.is_reference && !s.unstable) best.push_back(s);
    std::sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    out += "<polyline fill='none' stroke='#1663a6' points='";
    for (const auto& s : best) out += fmt::format("{:.1f},{:.1f} ", x.at(s.cost), y.at(seen_error(s)));
    out += "'/>\n";
    for (const auto& s : settings) {
        if (s.is_reference || s.unstable) continue;
        const bool named = settings.size() <= most_names || !s.dominated;
        out += fmt::format(
            "<circle cx='{0:.1f}' cy='{1:.1f}' r='4' stroke='#1663a6' fill='{2}'/>"
            "<text x='{3:.1f}' y='{4:.1f}' font-size='9' transform='rotate(-40 {3:.1f} {4:.1f})'>{5}</text>\n",
            x.at(s.cost), y.at(seen_error(s)), s.dominated ? "#fff" : "#1663a6", x.at(s.cost) + 4,
            y.at(seen_error(s)) - 5, named ? s.name : "");
    }
    return out;
}

}  // namespace

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double mean(const Runs& runs) {
    double sum = 0;
    for (const double x : runs) sum += x / static_cast<double>(runs.size());
    return sum;
}

double error_of_mean(const Runs& runs) {
    const double centre = mean(runs);
    double square = 0;
    for (const double x : runs) square += (x - centre) * (x - centre);
    const auto n = static_cast<double>(runs.size());
    return std::sqrt(square / (n - 1) / n);
}

void compare_means(std::vector<Setting>& settings, const std::vector<Runs>& runs) {
    std::size_t reference = 0;
    for (std::size_t k = 0; k < settings.size(); ++k)
        if (settings[k].is_reference) reference = k;
    const double scale = mean(runs[reference]);
    for (std::size_t k = 0; k < settings.size(); ++k) {
        if (k == reference) continue;
        Runs differences;
        for (std::size_t seed = 0; seed < std::min(runs[k].size(), runs[reference].size()); ++seed)
            differences.push_back((runs[k][seed] - runs[reference][seed]) / scale);
        settings[k].error = mean(differences);
        settings[k].unstable = std::isnan(settings[k].error);
        settings[k].uncertainty = error_of_mean(differences);
    }
}

void mark_dominated(std::vector<Setting>& settings) {
    for (auto& s : settings)
        s.dominated = std::any_of(settings.begin(), settings.end(), [&](const Setting& other) {
            return other.scene == s.scene && &other != &s && !other.is_reference && !other.unstable &&
                   other.cost <= s.cost && seen_error(other) <= seen_error(s) &&
                   (other.cost < s.cost || seen_error(other) < seen_error(s));
        });
}

std::string json_line(const Setting& s) {
    if (s.unstable)
        return fmt::format(
            "{{\"bench\": \"accuracy\", \"scene\": \"{}\", \"setting\": \"{}\", \"outcome\": "
            "\"unstable\"}}",
            s.scene, s.name);
    return fmt::format(
        "{{\"bench\": \"accuracy\", \"scene\": \"{}\", \"setting\": \"{}\", \"measured\": \"{}\", "
        "\"cost_seconds\": {:.4g}, \"relative_error\": {:.3g}, \"uncertainty\": {:.2g}, "
        "\"reference\": {}, \"dominated\": {}}}",
        s.scene, s.name, s.measured, s.cost, s.error, s.uncertainty, s.is_reference, s.dominated);
}

void draw(const std::vector<Setting>& settings, const std::filesystem::path& svg) {
    std::vector<std::vector<Setting>> scenes;
    for (const auto& s : settings) {
        const auto same =
            std::find_if(scenes.begin(), scenes.end(), [&](const auto& scene) { return scene[0].scene == s.scene; });
        if (same == scenes.end())
            scenes.push_back({s});
        else
            same->push_back(s);
    }
    const auto rows = (scenes.size() + 1) / 2;
    std::ofstream out(svg);
    out << fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} "
        "{1:.0f}' font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' "
        "fill='#fff'/>\n",
        2 * panel_width, static_cast<double>(rows) * panel_height);
    for (std::size_t k = 0; k < scenes.size(); ++k)
        out << panel(scenes[k], static_cast<double>(k % 2) * panel_width, static_cast<double>(k / 2) * panel_height);
    out << "</svg>\n";
    if (!out.flush()) throw std::runtime_error("cannot write " + svg.string());
}

}  // namespace grainsweep::tests
