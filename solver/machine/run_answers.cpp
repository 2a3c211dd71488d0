// Answers of a run so far: reduced measurements, expressions of them, and the observables of every machine.
#include "solver/machine/frames.hpp"
#include "solver/machine/reduction.hpp"
#include "solver/machine/run.hpp"
#include "solver/machine/setup.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace grainsweep::machine {

std::string Run::with_names(std::string fault) const {
    constexpr std::string_view word = "wall ";
    const std::size_t at = fault.find(word);
    if (at == std::string::npos) return fault;
    const std::size_t begin = at + word.size(), end = fault.find_first_not_of("0123456789", begin);
    if (end == begin || begin == fault.size()) return fault;
    const auto number = std::stoull(fault.substr(begin, end - begin));
    if (number < spec_.walls.size())
        fault.replace(begin, (end == std::string::npos ? fault.size() : end) - begin,
                      "'" + spec_.walls[number].name + "'");
    return fault;
}

/// Returns the bound of its speed that alone holds a wall back which forces move; empty: none.
static std::string bound_of(const geometry::Motion& motion) {
    constexpr double rounding = 1e-9;
    if (const auto* press = std::get_if<geometry::Press>(&motion);
        press != nullptr && std::abs(press->speed) >= press->fastest)
        return kit::sentence("moves at its speed_at_most of %.3g m/s: the powder does not carry its force",
                             press->fastest);
    if (const auto* drive = std::get_if<geometry::Drive>(&motion);
        drive != nullptr && std::abs(drive->speed) >= drive->fastest)
        return kit::sentence("turns at its speed_at_most of %.3g rad/s: the powder does not carry its torque",
                             drive->fastest);
    if (const auto* body = std::get_if<geometry::Flight>(&motion);
        body != nullptr && (geometry::norm(body->velocity) >= (1 - rounding) * body->fastest ||
                            geometry::norm(geometry::spin_of(*body)) >= (1 - rounding) * body->fastest_turn))
        return kit::sentence("moves at its speed_at_most of %.3g m/s: without this bound it would be faster",
                             body->fastest);
    return {};
}

/// A constant torque has no threshold: at rest each step turns a particle to and fro, and a loaded bed creeps.
std::string Run::remark_of_creep() const {
    constexpr double least_energy = 1e-4;  // of that motion, in m g d: a tenth of what counts as rest
    constexpr double least_way = 0.1;      // in the last phase, diameters
    if (spec_.pairs.front().rolling_law != dem::RollingLaw::cdt || times_.end.empty()) return {};
    dem::State state;
    std::vector<dem::ContactForce> contacts;
    engine_->state(state), engine_->contacts(contacts);
    double speed = 0, diameter = 0, count = 0;
    for (const dem::ContactForce& contact : contacts) {
        const auto at = static_cast<std::size_t>(std::ranges::lower_bound(state.id, contact.first) - state.id.begin());
        const double r = state.radius[at], moment = geometry::norm(contact.rolling_moment);
        if (state.mobile[at] == 0 || moment == 0) continue;
        const double mass = density_[static_cast<std::size_t>(contact.first)] * 4 / 3 * std::numbers::pi * r * r * r;
        speed += moment * engine_->part() / (0.4 * mass * r);
        diameter += 2 * r;
        ++count;
    }
    if (count == 0) return {};
    speed /= count, diameter /= count;
    const double rest = std::sqrt(2 * least_energy * geometry::norm(spec_.gravity) * diameter);
    const double way = speed * (times_.end.back() - times_.begin[times_.end.size() - 1]);
    if (speed < rest || way < least_way * diameter) return {};
    return kit::sentence(
        "rolling_law cdt turns loaded particles to and fro in every time step, by %.2g m/s at their surface, so that "
        "the bed creeps: take rolling_law epsd, or a shorter time step",
        speed);
}

std::string Run::remark() const {
    constexpr double many = 0.1;   // of the particles: a vessel that does not hold its filling; a feed flows through
    constexpr double deep = 0.05;  // overlap divided by the diameter: here Hertz's force errs by about as much
    const auto filled = static_cast<double>(so_far());
    std::string lost, soft;
    const bool fed = std::ranges::any_of(spec_.feeds, [](const Feed& feed) { return holds(feed.during, 0); });
    if (spec_.phases.size() > 1 && !fed && static_cast<double>(lost_first_) > many * filled)
        lost = kit::sentence(
            "%.0f of %.0f particles left the domain during the first phase: look with draw whether the "
            "vessel holds its filling",
            static_cast<double>(lost_first_), filled);
    const double at_walls = judged_wall_overlap_, largest = std::max(at_walls, judged_overlap_);
    if (largest > deep)
        soft = (at_walls < largest ? "particles overlapped each other" : "particles overlapped a wall") +
               kit::sentence(
                   " by up to %.2g of a diameter, and contact laws hold for small overlaps (%.2g): forces and "
                   "torques of these contacts are not reliable, so raise youngs_modulus, or give pinched "
                   "particles room",
                   largest, deep);
    std::string free;
    for (std::size_t w = 0; w < spec_.walls.size() && free.empty(); ++w)
        for (const auto& motion : engine_->wall(w).motions)
            if (const std::string bound = bound_of(motion); !bound.empty())
                free = "at the end wall '" + spec_.walls[w].name + "' still " + bound;
    std::string all;
    for (const std::string& one : {lost, soft, free, remark_of_creep(), flaw_of_frames(spec_)})
        if (!one.empty()) all += (all.empty() ? "" : "; ") + one;
    return all;
}

void Run::observe(const Measure& measure, const Record& record, Observations& into) const {
    const ReductionInfo& reduction = *find_reduction(measure.reduction);
    const Scale& scale = measure.scale;
    if (reduction.shape == Shape::profile) {
        std::vector<Sample> profile;
        if (reduction.every) profile = record.samples;
        for (std::size_t b = 0; b < record.bins.size() && !reduction.every; ++b) {
            const double value = reduction.last ? record.last[b] : record.sums[b] / record.counts[b];
            if (std::isfinite(value)) profile.push_back({.bin = record.bins[b], .value = value});
        }
        for (Sample& one : profile) one.time /= scale.time, one.bin /= scale.bin, one.value /= scale.value;
        if (!profile.empty()) into.series[measure.name] = std::move(profile);
        return;
    }
    if (measure.repeats == Measure::Repeats::each) return observe_each(measure, record, into);
    if (reduction.shape != Shape::series) {
        const auto [value, error] =
            reduced(measure, measure.repeats == Measure::Repeats::all ? record : part_of(record, last_run(measure)));
        if (std::isfinite(value)) into.scalars[measure.name] = value / scale.value;
        if (std::isfinite(error)) into.scalars[measure.error] = error / scale.value;
        return;
    }
    return observe_series(measure, record, into);
}

void Run::observe_series(const Measure& measure, const Record& record, Observations& into) const {
    const Scale& scale = measure.scale;
    if (measure.since && *measure.since >= times_.begin.size()) return;  // its zero of time is still to come
    std::vector<Sample> samples = record.samples;
    std::optional<double> since;
    if (measure.since) since = times_.begin[*measure.since];
    if (measure.repeats == Measure::Repeats::last) {
        const WhileIn run = last_run(measure);
        samples = part_of(record, run).samples;
        if (measure.since) since = times_.begin[std::min(run.first, times_.begin.size() - 1)];
    }
    if (measure.shares) samples = between_shares(samples, measure.shares->first, measure.shares->second);
    for (const While& only : measure.only)
        samples = while_between(samples, records_[only.measure].samples, only.low, only.high);
    if (measure.reduction == "rates") samples = with_rates(samples);
    for (Sample& sample : samples) {
        sample.time = (sample.time - since.value_or(0)) / scale.time;
        sample.value /= scale.value;
    }
    if (!samples.empty()) into.series[measure.name] = std::move(samples);
}

std::pair<double, double> Run::reduced(const Measure& measure, const Record& record) const {
    const ReductionInfo& reduction = *find_reduction(measure.reduction);
    std::vector<Sample> samples = record.samples;
    if (measure.shares) samples = between_shares(samples, measure.shares->first, measure.shares->second);
    for (const While& only : measure.only)
        samples = while_between(samples, records_[only.measure].samples, only.low, only.high);
    if (const std::vector<FrameInterval> over = ending_at(record.intervals, samples); !over.empty())
        return {reduction.of_intervals(over),
                reduction.error_of_intervals == nullptr ? undefined : reduction.error_of_intervals(over)};
    if (reduction.last && !record.samples.empty() && record.samples.back().time != record.looked)
        return {undefined, undefined};
    return {reduction.of(samples), reduction.error == nullptr ? undefined : reduction.error(samples)};
}

Run::Record Run::part_of(const Record& record, const WhileIn& phases) const {
    Record part = record;
    const double begin = times_.begin[std::min(phases.first, times_.begin.size() - 1)];
    const double end = phases.last < times_.end.size() ? times_.end[phases.last] : time();
    const auto outside = [&](double time) { return time < begin || time > end; };
    std::erase_if(part.samples, [&](const Sample& sample) { return outside(sample.time); });
    std::erase_if(part.intervals, [&](const FrameInterval& one) { return outside(one.end) || one.end == begin; });
    part.looked = std::min(part.looked, end);
    return part;
}

WhileIn Run::last_run(const Measure& measure) const {
    const auto runs = runs_of(spec_, measure);
    std::size_t last = 0;
    while (last + 1 < runs.size() && runs[last + 1].first <= phase_) ++last;
    return runs.empty() ? WhileIn{} : runs[last];
}

/// A value for each time that the phases came, by its number from 1.
void Run::observe_each(const Measure& measure, const Record& record, Observations& into) const {
    std::vector<Sample> values;
    double number = 0;
    for (const WhileIn& phases : runs_of(spec_, measure)) {
        if (phases.first >= times_.begin.size()) break;
        number += 1;
        const double value = reduced(measure, part_of(record, phases)).first / measure.scale.value;
        if (std::isfinite(value)) values.push_back({.bin = number, .value = value});
    }
    if (!values.empty()) into.series[measure.name] = std::move(values);
}

void Run::observe(Observations& into) const {
    const std::int64_t now = present();
    into.scalars["particles"] = static_cast<double>(now - glued_);
    into.scalars["lost"] = static_cast<double>(lost());
    into.scalars["max_overlap"] = peak_overlap();
    into.scalars["max_wall_overlap"] = peak_wall_overlap();
    into.scalars["smallest_step"] = spec_.time_step / static_cast<double>(engine_->work().most_parts);
    for (const auto& [name, count] : counts_) into.scalars[name] = static_cast<double>(count);
    for (std::size_t k = 0; k < feeders_.size(); ++k) {
        into.scalars[spec_.feeds[k].name + "_fed"] = feeders_[k].fed();
        into.scalars[spec_.feeds[k].name + "_waiting"] = std::max(0.0, feeders_[k].waiting());
    }
    std::map<std::string, double, std::less<>> lasted;  // repeated phases together
    for (std::size_t p = 0; p < times_.end.size(); ++p) {
        if (spec_.phases[p].until.empty()) continue;
        into.scalars[spec_.phases[p].name + "_time"] = lasted[spec_.phases[p].name] += times_.end[p] - times_.begin[p];
        into.scalars[spec_.phases[p].name + "_ended"] = ended_by_[p];
    }
    // A measurement of the machine with one of these names replaces it.
    for (const auto& measure : spec_.measures) into.scalars.erase(measure.name);
    for (const auto& derived : spec_.derived) into.scalars.erase(derived.name);
    for (const auto& time_of : spec_.times) into.scalars.erase(time_of.name);
    for (std::size_t m = 0; m < spec_.measures.size(); ++m) observe(spec_.measures[m], records_[m], into);
    for (const TimeOf& time_of : spec_.times)
        if (const auto time = crossing_time(records_[time_of.measure].samples, time_of.value, time_of.above))
            into.scalars[time_of.name] = *time / time_of.scale.value;
    for (const Derived& derived : spec_.derived) {
        const bool known =
            std::ranges::all_of(derived.needs, [&](const auto& name) { return into.scalars.contains(name); });
        if (!known) continue;
        if (const double value = derived.value(into.scalars); std::isfinite(value)) {
            into.scalars[derived.name] = value;
        } else {  // nothing, or a measurement that is withdrawn
            into.scalars.erase(derived.name);
            if (!derived.error.empty()) into.scalars.erase(derived.error);
        }
    }
}

}  // namespace grainsweep::machine
