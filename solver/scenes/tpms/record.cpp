#include "solver/scenes/tpms/record.hpp"

#include "solver/geometry/vector.hpp"
#include "solver/observables/histogram.hpp"
#include "solver/scenes/tpms/observables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace grainsweep {
namespace {

constexpr double quiet_time = 1.5;    // t*
constexpr double quiet_periods = 2;   // of vibration
constexpr double quiet_share = 1e-3;  // of the powder in the cell may move faster, and leave
constexpr int bins_per_decade = 20;
constexpr double least_overlap = 1e-6, least_force = 1e-3;  // smaller values count as this

}  // namespace

double TpmsRecord::in_t_star(double step) const {
    return step * question_->time_step / question_->free_fall_time();
}

void TpmsRecord::add(const Moment& now) {
    const auto few =
        std::max<std::int64_t>(1, static_cast<std::int64_t>(quiet_share * static_cast<double>(now.in_cell)));
    if (now.in_cell - now.at_rest > few || std::abs(now.in_cell - quiet_count_) > few) {
        quiet_since_ = now.step;
        quiet_count_ = now.in_cell;
    }
    moments_.push_back(now);
}

void TpmsRecord::add(std::span<const dem::ContactForce> contacts, std::int64_t step, bool histograms) {
    std::vector<double> overlaps, forces;
    for (const auto& contact : contacts) {
        const double force = std::sqrt(contact.normal_force * contact.normal_force +
                                       geometry::dot(contact.tangential_force, contact.tangential_force));
        max_force_ = std::max(max_force_, force / question_->standard_weight());
        if (!histograms) continue;
        overlaps.push_back(contact.overlap / question_->diameter);
        forces.push_back(force / question_->standard_weight());
    }
    for (const auto& [centre, share] : observables::log_histogram(overlaps, bins_per_decade, least_overlap))
        overlaps_.push_back({step, centre, share});
    for (const auto& [centre, share] : observables::log_histogram(forces, bins_per_decade, least_force))
        forces_.push_back({step, centre, share});
}

bool TpmsRecord::is_quiet(std::int64_t step) const {
    const double frequency = question_->shaking.frequency;
    const double needed =
        std::max(quiet_time * question_->free_fall_time(), frequency > 0 ? quiet_periods / frequency : 0.0);
    return static_cast<double>(step - quiet_since_) * question_->time_step >= needed;
}

double TpmsRecord::time_to(double share) const {
    const double target = share * static_cast<double>(start_);
    for (std::size_t k = 1; k < moments_.size(); ++k) {
        const auto before = static_cast<double>(moments_[k - 1].in_cell);
        const auto after = static_cast<double>(moments_[k].in_cell);
        if (after > target) continue;
        const double part = before > after ? (before - target) / (before - after) : 0;
        const auto from = static_cast<double>(moments_[k - 1].step);
        return in_t_star(from + part * (static_cast<double>(moments_[k].step) - from));
    }
    return std::numeric_limits<double>::quiet_NaN();
}

void TpmsRecord::observe(Observations& into) const {
    const auto start = static_cast<double>(start_);
    double peak = 0;
    auto& retention = tpms_record::retention_series.in(into);
    auto& velocity = tpms_record::velocity_series.in(into);
    auto& mobile = tpms_record::mobile_series.in(into);
    auto& at_rest = tpms_record::at_rest_series.in(into);
    for (const Moment& moment : moments_) {
        const double t = in_t_star(static_cast<double>(moment.step));
        const double speed = moment.fastest_down / question_->free_fall_speed();
        retention.push_back({.time = t, .value = static_cast<double>(moment.in_cell) / start});
        velocity.push_back({.time = t, .value = speed});
        mobile.push_back({.time = t, .value = static_cast<double>(moment.mobile) / start});
        at_rest.push_back({.time = t, .value = static_cast<double>(moment.at_rest) / start});
        if (moment.in_cell > 0) peak = std::max(peak, speed);
    }
    const auto add_bins = [&](const kit::Profile& histogram, const std::vector<Bin>& bins) {
        auto& series = histogram.in(into);
        for (const Bin& bin : bins)
            series.push_back({.time = in_t_star(static_cast<double>(bin.step)), .bin = bin.centre, .value = bin.share});
    };
    add_bins(tpms_record::overlap_histogram, overlaps_);
    add_bins(tpms_record::force_histogram, forces_);
    tpms_record::retention.record(into, static_cast<double>(moments_.back().in_cell) / start);
    tpms_record::time_to_half.record(into, time_to(0.5));
    tpms_record::time_to_tenth.record(into, time_to(0.1));
    tpms_record::discharge_rate.record(into, 0.25 / (time_to(0.5) - time_to(0.75)));
    tpms_record::peak_velocity.record(into, peak);
    tpms_record::max_force.record(into, max_force_);
}

void TpmsRecord::save(ByteWriter& out) const {
    out.put(quiet_since_);
    out.put(quiet_count_);
    out.put(max_force_);
    out.put(moments_);
    out.put(overlaps_);
    out.put(forces_);
}

void TpmsRecord::restore(ByteReader& in) {
    in.get(quiet_since_);
    in.get(quiet_count_);
    in.get(max_force_);
    in.get(moments_);
    in.get(overlaps_);
    in.get(forces_);
    in.require(!moments_.empty());
}

}  // namespace grainsweep
