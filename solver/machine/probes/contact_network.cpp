// Statistics of the contacts between particles: the sizes of normal forces, and the directions of normals.
//
// The histogram has equal bins of the logarithm. Of f/<f>, f the size of the normal force and <f> its mean over the
// contacts of a frame, the profile is the probability density. Fabric (Satake 1982): F_ab = <n_a n_b> over the
// contacts, trace 1;
//
//     component along a direction e: e.F.e, 1/3 in an isotropic bed
//     anisotropy = sqrt(3/2 F'_ab F'_ab), F' = F less its trace: 0 isotropic, 1/2 all in a plane, 1 all parallel
#include "solver/machine/binning.hpp"
#include "solver/machine/contact_place.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::machine::probes {
namespace {

/// Calls visit(contact) for contacts of two particles that count: of the species both, in the region the contact.
class ContactSelection {
public:
    explicit ContactSelection(const Options& options) : of_(options), in_(options.region("in")) {}
    template <class Visit>
    void each(const Frame& frame, Visit&& visit) const {
        for (const auto& contact : frame.contacts)
            if (contact.second >= 0 && of_.hold(frame, contact.first) && of_.hold(frame, contact.second) &&
                (!in_ || in_->contains(contact_point(frame, contact))))
                visit(contact);
    }

private:
    SelectedSpecies of_;
    std::optional<Region> in_;
};

constexpr double largest_ratio = 6;

template <bool density>
class ContactForces final : public machine::Probe {
public:
    explicit ContactForces(const Options& options)
        : selection_(options), bins_{0, options.number("to", largest_ratio), bins_in(options)} {}
    double look(const Frame& frame) override {
        forces_.clear();
        mean_ = 0;
        selection_.each(frame, [&](const dem::ContactForce& c) { forces_.push_back(std::abs(c.normal_force)); });
        for (const double f : forces_) mean_ += f / static_cast<double>(forces_.size());
        return forces_.empty() || density ? undefined : mean_;
    }
    void profile(const Frame&, std::vector<Sample>& into) override { append_density(into, bins_, forces_, mean_); }

private:
    ContactSelection selection_;
    Bins bins_;
    std::vector<double> forces_;  // N, of the last look
    double mean_ = 0;
};

double size_of_force(const dem::ContactForce& c) {
    return std::sqrt(c.normal_force * c.normal_force + geometry::dot(c.tangential_force, c.tangential_force));
}

class LargestForce final : public machine::Probe {
public:
    explicit LargestForce(const Options& options) : selection_(options) {}
    double look(const Frame& frame) override {
        double largest = 0;
        selection_.each(frame, [&](const dem::ContactForce& c) { largest = std::max(largest, size_of_force(c)); });
        return largest;
    }

private:
    ContactSelection selection_;
};

/// Bin k covers [10^(k/n), 10^((k+1)/n)), n bins a decade, of values divided by the unit; its centre is the geometric
/// mean. The first and the last bin also count what lies beyond them.
class ContactHistogram final : public machine::Probe {
public:
    explicit ContactHistogram(const Options& options)
        : selection_(options),
          overlaps_(options.word("quantity", "force") == "overlap"),
          unit_(options.number("unit", 1)),
          from_(options.number("from")),
          per_decade_(options.number("per_decade", 20)),
          first_(bin_of(from_)),
          count_(static_cast<std::size_t>(
              std::max(1.0, std::ceil(std::log10(options.number("to")) * per_decade_) - first_))) {}
    double look(const Frame&) override { return undefined; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        std::vector<double> numbers(count_, 0.0);
        double all = 0;
        selection_.each(frame, [&](const dem::ContactForce& c) {
            const double value = (overlaps_ ? c.overlap : size_of_force(c)) / unit_;
            const double bin = value > from_ ? std::min(bin_of(value) - first_, static_cast<double>(count_ - 1)) : 0;
            ++numbers[static_cast<std::size_t>(bin)];
            ++all;
        });
        for (std::size_t b = 0; b < count_; ++b)
            into.push_back({.bin = std::pow(10, (first_ + static_cast<double>(b) + 0.5) / per_decade_),
                            .value = numbers[b] / all});
    }

private:
    [[nodiscard]] double bin_of(double value) const { return std::floor(std::log10(value) * per_decade_); }
    ContactSelection selection_;
    bool overlaps_;
    double unit_, from_, per_decade_, first_;
    std::size_t count_;
};

class Fabric final : public machine::Probe {
public:
    explicit Fabric(const Options& options)
        : selection_(options), component_(options.has("along")), along_(options.vector("along", {})) {}
    double look(const Frame& frame) override {
        double contacts = 0, parallel = 0;
        std::array<Vec3, 3> sum{};
        selection_.each(frame, [&](const dem::ContactForce& c) {
            ++contacts;
            const double share = geometry::dot(c.normal, along_);
            parallel += share * share;
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = 0; b < 3; ++b) sum[a][b] += c.normal[a] * c.normal[b];
        });
        if (contacts == 0) return undefined;
        if (component_) return parallel / contacts;
        double squares = 0;
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
                const double f = sum[a][b] / contacts - (a == b ? 1.0 / 3 : 0);
                squares += f * f;
            }
        return std::sqrt(1.5 * squares);
    }

private:
    ContactSelection selection_;
    bool component_;
    Vec3 along_;
};

constexpr Field both_of_option =
    option("of", Field::Kind::species, "", "the species both particles are of; default: all");
constexpr std::array contact_force_options = {both_of_option, contact_in_option};
constexpr std::array contact_density_options = {
    both_of_option, contact_in_option,
    option("to", Field::Kind::quantity, "1", "the force where the last bin ends, divided by the mean; default: 6",
           false, {0, 1e6, true, false}),
    bins_option};
constexpr std::array<std::string_view, 2> histogram_words = {"force", "overlap"};
constexpr std::array contact_histogram_options = {
    both_of_option,
    contact_in_option,
    option("quantity", Field::Kind::word, "", "'force' (N) or 'overlap' (m); default: force", false, {},
           histogram_words),
    option("unit", Field::Kind::quantity, "1", "values are divided by it; default: 1", false, positive_number),
    option("from", Field::Kind::quantity, "1", "where the first bin begins, in this unit", true, {1e-30, 1e30}),
    option("to", Field::Kind::quantity, "1", "where the last bin ends, in this unit", true, {1e-30, 1e30}),
    option("per_decade", Field::Kind::quantity, "1", "number of bins in a decade; default: 20", false, {1, 1000})};
constexpr std::array fabric_options = {
    both_of_option, contact_in_option,
    option("along", Field::Kind::direction, "", "the component along it; default: the anisotropy")};

std::string flaw_of_contact_density(const Options& given) {
    return flaw_of_bins(given, 0, given.number("to", largest_ratio));
}

std::string flaw_of_contact_histogram(const Options& given) {
    const double bins = given.number("per_decade", 20);
    if (bins != std::floor(bins)) return "\"per_decade\" must be a whole number";
    return given.number("from") < given.number("to") ? "" : "\"from\" of a histogram must lie below \"to\"";
}

}  // namespace

ProbeInfo largest_contact_force() {
    return probe_row<LargestForce>("largest_contact_force", "N",
                                   "largest force between two particles, normal and tangential together; 0: none touch",
                                   contact_force_options, {.contacts = true});
}
ProbeInfo contact_histogram() {
    return probe_row<ContactHistogram>(
        "contact_histogram", "1",
        "share of the contacts between particles in bins of force or overlap, equal on a logarithmic axis",
        contact_histogram_options,
        {.contacts = true, .over = "force or overlap divided by the unit", .flaw = flaw_of_contact_histogram});
}
ProbeInfo contact_force() {
    return probe_row<ContactForces<false>>("contact_force", "N", "mean size of the normal force between particles",
                                           contact_force_options, {.contacts = true});
}
ProbeInfo contact_force_density() {
    return probe_row<ContactForces<true>>(
        "contact_force_density", "1", "probability density of normal forces divided by their mean",
        contact_density_options,
        {.contacts = true, .over = "force divided by the mean force", .flaw = flaw_of_contact_density});
}
ProbeInfo fabric() {
    return probe_row<Fabric>(
        "fabric", "1",
        "anisotropy of the directions of contacts between particles, 0 to 1, or a component of their fabric tensor",
        fabric_options, {.contacts = true});
}

}  // namespace grainsweep::machine::probes
