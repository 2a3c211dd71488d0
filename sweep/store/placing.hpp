// Entry of the cases and places of a campaign that are not yet in the file. A long campaign is entered in pieces, in
// the order of its design, while its first cases are computed. If the program ends before all are entered, the next run
// continues. Internal to enrolling.
#pragma once

#include "sweep/campaign/cases.hpp"
#include "sweep/store/checksum.hpp"
#include "sweep/store/store.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::store {

struct DeclaredParameter {
    std::string name;
    std::int64_t key = 0;
    Value default_value;
};
/// Stores the inputs of a case that differ from the defaults. `parameters` are sorted by name.
void enter_inputs(Connection& db, std::int64_t key, const campaign::Case& question,
                  const std::vector<DeclaredParameter>& parameters);

/// Stored state of the cases of a list, place by place. A case that stands at several places has its key at the first
/// of them.
struct KnownCases {
    std::vector<std::int64_t> keys;  ///< 0: not in the file
    std::vector<CaseState> states;
};
[[nodiscard]] KnownCases known_cases(const Connection& db, const campaign::Cases& cases);

/// Returns the outcome in a column; empty for NULL.
[[nodiscard]] std::optional<campaign::Outcome> outcome_at(const Rows& rows, int column);

class Placing {
public:
    Placing(campaign::Cases cases, std::vector<std::int64_t> keys, std::vector<DeclaredParameter> parameters,
            std::int64_t campaign_key)
        : cases_(std::move(cases)),
          keys_(std::move(keys)),
          parameters_(std::move(parameters)),
          campaign_key_(campaign_key) {}

    /// Compares the places with the stored ones. Returns false if the stored ones cannot simply be extended: they are
    /// damaged, or have other cases.
    [[nodiscard]] bool adds_to(const Connection& db);
    /// Returns, after adds_to(), whether a new place stands before a stored one.
    [[nodiscard]] bool inside() const { return inside_; }
    /// Enters up to `places` of the remaining places, and their cases. Inside a transaction.
    void enter(Connection& db, std::size_t places);
    [[nodiscard]] bool done() const { return next_ == cases_.size(); }

    /// Enters every case, without its places.
    void enter_cases(Connection& db);
    /// Returns the key of the case at place i; 0: not entered.
    [[nodiscard]] std::int64_t key(std::size_t i) const { return keys_[cases_.first(i)]; }

private:
    void enter_case(Connection& db, std::size_t i);

    campaign::Cases cases_;
    std::vector<std::int64_t> keys_;  ///< as in KnownCases
    std::vector<DeclaredParameter> parameters_;
    std::int64_t campaign_key_;
    std::vector<bool> there_;  ///< the place is in the file
    bool inside_ = false;
    std::size_t next_ = 0;
    campaign::Case question_;  // reused to avoid allocations
};

}  // namespace grainsweep::store
