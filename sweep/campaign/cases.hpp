// The cases of a campaign in the order of its design. What stands in memory is a few columns: where a case stands and
// its id, 36 bytes a case beside the coordinates of its point. The question itself, a pure function of the point, is
// made when it is asked for.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::campaign {

/// Place of a case in a design. A design has less than 2^28 points.
struct Place {
    std::uint32_t point = 0, sequence = 0, replicate = 0;
    auto operator<=>(const Place&) const = default;
};

/// Makes the cases at the places of a list.
class Questions {
public:
    Questions() = default;
    Questions(const Questions&) = delete;
    Questions& operator=(const Questions&) = delete;
    virtual ~Questions() = default;
    /// Makes the case at place i. Inputs that `into` has from an earlier call, and that do not vary, are left as
    /// they are.
    virtual void make(std::size_t i, const Place& place, Case& into) const = 0;
    /// Its inputs alone, in the same way.
    virtual void make_inputs(std::size_t i, const Place& place, Inputs& into) const = 0;
};

/// Copies share their columns. Nothing changes them, so that threads may read them side by side.
class Cases {
public:
    Cases() : Cases(std::span<const PlacedCase>()) {}
    /// Cases that were made before.
    Cases(std::span<const PlacedCase> listed);    // NOLINT(google-explicit-constructor)
    Cases(const std::vector<PlacedCase>& listed)  // NOLINT(google-explicit-constructor)
        : Cases(std::span<const PlacedCase>(listed)) {}
    /// `hashes` are the ids of the questions, place by place.
    Cases(std::vector<Place> places, std::vector<CaseHash> hashes, std::shared_ptr<const Questions> questions);

    [[nodiscard]] std::size_t size() const { return columns_->places.size(); }
    [[nodiscard]] bool empty() const { return size() == 0; }
    [[nodiscard]] const Place& place(std::size_t i) const { return columns_->places[i]; }
    [[nodiscard]] const CaseHash& hash(std::size_t i) const { return columns_->hashes[i]; }
    [[nodiscard]] CaseId id(std::size_t i) const;
    [[nodiscard]] Case question(std::size_t i) const;
    /// The same into a case, or inputs, that this list filled before, or that are empty.
    void question(std::size_t i, Case& into) const { columns_->questions->make(i, place(i), into); }
    void inputs(std::size_t i, Inputs& into) const { columns_->questions->make_inputs(i, place(i), into); }
    [[nodiscard]] PlacedCase operator[](std::size_t i) const;

    /// Returns the first place with the case of this id.
    [[nodiscard]] std::optional<std::size_t> find(const CaseHash& hash) const;
    /// Returns the next place with the same case as place i.
    [[nodiscard]] std::optional<std::size_t> next(std::size_t i) const;
    /// Returns the first place with the same case as place i.
    [[nodiscard]] std::size_t first(std::size_t i) const { return columns_->next.empty() ? i : *find(hash(i)); }
    /// Whether no place before i has the same case.
    [[nodiscard]] bool is_first(std::size_t i) const { return first(i) == i; }

    class Iterator {
    public:
        using difference_type = std::ptrdiff_t;
        using value_type = PlacedCase;
        Iterator() = default;
        Iterator(const Cases* cases, std::size_t at) : cases_(cases), at_(at) {}
        PlacedCase operator*() const { return (*cases_)[at_]; }
        Iterator& operator++() {
            ++at_;
            return *this;
        }
        Iterator operator++(int) {
            Iterator before = *this;
            ++at_;
            return before;
        }
        bool operator==(const Iterator&) const = default;

    private:
        const Cases* cases_ = nullptr;
        std::size_t at_ = 0;
    };
    [[nodiscard]] Iterator begin() const { return {this, 0}; }
    [[nodiscard]] Iterator end() const { return {this, size()}; }

private:
    struct Columns {
        std::vector<Place> places;
        std::vector<CaseHash> hashes;
        std::vector<std::uint32_t> slots;  ///< of a hash table: the number of a place plus 1; 0: free
        std::vector<std::uint32_t> next;   ///< the same of the next place with this id; empty: each stands once
        std::shared_ptr<const Questions> questions;
        void fill_table();
        [[nodiscard]] std::size_t slot_of(const CaseHash& hash) const;
    };
    std::shared_ptr<const Columns> columns_;
};

}  // namespace grainsweep::campaign
