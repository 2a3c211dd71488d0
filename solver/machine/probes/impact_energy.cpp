// Energy that contacts dissipate, contact by contact.
//
//     E = sum over the steps of a contact of dt (-F_n v_n - F_t . v_t - M . w_ij)
//
// F and M act in the step, the velocities v and w_ij of i against j are those of the full step. E is exactly the energy
// that all steps have removed from the motion of both bodies, also between frames. For a contact that has ended it is
// the dissipated energy, because its springs store nothing then. A contact lasts from touch to separation; places in
// which a particle touches one wall at once are one contact. "part" splits E into the term with F_n and the rest. Of
// contacts that last the sum contains what their springs hold. The error is rounding: about 1e-12 in double precision,
// and in mixed precision 1e-3 of the loss of an impact, or 1e-7 of the kinetic energy where this is more. At the
// beginning of a phase, and where particles are added, forces change once between two steps: that half a step is
// missing.
#include "solver/machine/binning.hpp"
#include "solver/machine/partner_order.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainsweep::machine::probes {
namespace {

template <bool by_number>
class ImpactEnergy final : public machine::Probe {
public:
    explicit ImpactEnergy(const Options& options)
        : of_(options), walls_(options), bins_(bins_along(options)), in_bins_(bins_.count, 0.0) {
        bins_.low = std::log10(bins_.low), bins_.high = std::log10(bins_.high);
        const auto part = options.word("part", "all");
        normal_ = part == "tangential" ? 0 : 1;
        tangential_ = part == "normal" ? 0 : 1;
    }

    void step(const Frame& frame) override {
        now_.clear();
        auto before = lasting_.cbegin();
        for (const auto place : frame.by_partners) {
            const auto& contact = frame.contacts[place];
            if (!counts(frame, contact)) continue;
            const Lasting one{
                std::max(contact.first, contact.second), std::min(contact.first, contact.second),
                frame.time_step * (normal_ * contact.normal_power + tangential_ * contact.tangential_power)};
            if (!now_.empty() && now_.back().key() == one.key()) {
                now_.back().energy += one.energy;
                continue;
            }
            for (; before != lasting_.cend() && before->key() < one.key(); ++before) end(*before);
            now_.push_back(one);
            if (before != lasting_.cend() && before->key() == one.key()) now_.back().energy += before++->energy;
        }
        for (; before != lasting_.cend(); ++before) end(*before);
        lasting_.swap(now_);
    }

    double look(const Frame&) override {
        if (by_number) return ended_;
        double sum = energy_;
        for (const Lasting& contact : lasting_) sum += contact.energy;
        return sum;
    }
    void profile(const Frame&, std::vector<Sample>& into) override {
        for (std::size_t b = 0; b < bins_.count; ++b)
            into.push_back({.bin = std::pow(10, bins_.centre(b)), .value = in_bins_[b]});
    }

    void save(ByteWriter& out) const override {
        out.put(energy_), out.put(ended_), out.put(in_bins_), out.put(lasting_);
    }
    void restore(ByteReader& in) override {
        in.get(energy_), in.get(ended_), in.get(in_bins_), in.get(lasting_);
        in.require(in_bins_.size() == bins_.count && std::ranges::is_sorted(lasting_, {}, &Lasting::key));
    }

private:
    struct Lasting {
        std::int32_t first = 0, second = 0;  // ids, the larger first; or a particle and -1 - w of a wall
        double energy = 0;                   // J
        [[nodiscard]] std::uint64_t key() const { return partner_key(first, second); }
    };

    [[nodiscard]] bool counts(const Frame& frame, const dem::ContactForce& contact) const {
        return walls_.admit(contact) &&
               (of_.hold(frame, contact.first) || (contact.second >= 0 && of_.hold(frame, contact.second)));
    }
    void end(const Lasting& contact) {
        energy_ += contact.energy;
        ended_ += 1;
        const std::size_t bin = bins_.at(std::log10(contact.energy));
        if (bin < bins_.count) in_bins_[bin] += by_number ? 1 : contact.energy;
    }

    SelectedSpecies of_;
    SelectedWalls walls_;
    Bins bins_;          // of log10 of J
    double energy_ = 0;  // of contacts that have ended, J
    double ended_ = 0;
    std::vector<double> in_bins_;
    double normal_ = 1, tangential_ = 1;
    std::vector<Lasting> lasting_;  // by key
    std::vector<Lasting> now_;
};

constexpr std::array<std::string_view, 3> impact_parts = {"all", "normal", "tangential"};
constexpr Interval impact_energies{0, 1e9, true, false};
constexpr Field impact_of =
    option("of", Field::Kind::species, "", "species one of which takes part in the contact; default: all");
constexpr Field impact_part =
    option("part", Field::Kind::word, "",
           "'all', 'normal': by the normal force, 'tangential': by friction and rolling; default: "
           "all",
           false, {}, impact_parts);
constexpr std::array impact_number_options = {impact_of, only_walls_option};
constexpr std::array impact_options = {impact_of, only_walls_option, impact_part};
constexpr std::array impact_spectrum_options = {
    impact_of,
    only_walls_option,
    impact_part,
    option("from", Field::Kind::quantity, "J", "where the first bin begins; bins are equal in the logarithm", true,
           impact_energies),
    option("to", Field::Kind::quantity, "J", "where the last bin ends", true, impact_energies),
    bins_option};

}  // namespace

ProbeInfo impact_energy() {
    return probe_row<ImpactEnergy<false>>(
        "impact_energy", "J",
        "energy that contacts have dissipated in the phases that count; of lasting ones also what they store "
        "(contact_energy)",
        impact_options, {.source = Source::steps, .so_far = true});
}
ProbeInfo impact_energy_spectrum() {
    return probe_row<ImpactEnergy<false>>(
        "impact_energy_spectrum", "J", "the same of contacts that have ended, by their energy", impact_spectrum_options,
        {.over = "energy of a contact, J", .flaw = flaw_of_bins_along, .source = Source::steps, .so_far = true});
}
ProbeInfo impact_number() {
    return probe_row<ImpactEnergy<true>>("impact_number", "1", "contacts that have ended", impact_number_options,
                                         {.source = Source::steps, .so_far = true});
}
ProbeInfo impact_number_spectrum() {
    return probe_row<ImpactEnergy<true>>(
        "impact_number_spectrum", "1", "the same by the energy that they dissipated", impact_spectrum_options,
        {.over = "energy of a contact, J", .flaw = flaw_of_bins_along, .source = Source::steps, .so_far = true});
}

}  // namespace grainsweep::machine::probes
