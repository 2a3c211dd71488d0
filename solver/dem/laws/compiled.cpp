#include "solver/dem/laws/compiled.hpp"

#include "solver/dem/laws/any_contact.hpp"

#include <algorithm>

namespace grainsweep::dem {
namespace {

/// Calls f with the number and the type of every combination.
template <class F, class... Combinations>
void for_each_combination(CombinationList<Combinations...>, F&& f) {
    int k = 0;
    (f.template operator()<Combinations>(k++), ...);
}

}  // namespace

int combinations() {
    int count = 0;
    for_each_combination(Compiled{}, [&]<class C>(int) { ++count; });
    return count;
}

bool wants(const Material& m, Aspect aspect) {
    bool result = false;
    for_each_combination(Compiled{}, [&]<class C>(int) {
        C::for_each_law([&]<class L>() { result = result || (L::aspect == aspect && L::wanted(m)); });
    });
    return result;
}

bool fits(int combination, std::span<const Material> materials) {
    bool result = true;
    visit_combination(combination, Compiled{}, [&]<class C>() {
        result = std::ranges::all_of(materials, C::template Contact<double>::covers);
        if (C::columns == Columns::any) return;
        C::for_each_law([&]<class L>() { result = result && std::ranges::any_of(materials, L::wanted); });
    });
    return result;
}

CombinationFacts facts_of(int combination) {
    CombinationFacts facts{};
    visit_combination(combination, Compiled{}, [&]<class C>() {
        facts = {C::columns, C::template Contact<double>::spin};
        static_assert(C::template Contact<double>::memories <= memories_at_most);
        static_assert(C::template Contact<double>::constants <= constants_at_most);
    });
    return facts;
}

std::vector<Quantity> constants_of(int combination, const Material& material) {
    std::vector<Quantity> all;
    visit_combination(combination, Compiled{},
                      [&]<class C>() { all = C::template Contact<double>::constants_of(material); });
    return all;
}

std::unique_ptr<const AnyContact> make_contact(int combination, const Material& material) {
    std::unique_ptr<const AnyContact> contact;
    visit_combination(combination, Compiled{}, [&]<class C>() {
        contact = std::make_unique<ContactOf<typename C::template Contact<double>>>(material);
    });
    return contact;
}

}  // namespace grainsweep::dem
