// Contact whose laws are chosen at run time, in double precision and SI.
#pragma once

#include "solver/dem/laws/contact.hpp"

#include <memory>
#include <vector>

namespace grainsweep::dem {

class AnyContact {
public:
    struct Traits {
        bool spin, rolls, reaches, acts_apart, remembers_separation;
        std::vector<MemoryKind> memory;  ///< of every component
    };

    explicit AnyContact(Traits traits) : traits_(std::move(traits)) {}
    AnyContact(const AnyContact&) = delete;
    AnyContact& operator=(const AnyContact&) = delete;
    virtual ~AnyContact() = default;

    [[nodiscard]] const Traits& traits() const { return traits_; }
    /// Returns whether its laws can compute a material.
    [[nodiscard]] virtual bool covers(const Material& material) const = 0;
    /// Returns the same laws with the constants of another material.
    [[nodiscard]] virtual std::unique_ptr<const AnyContact> of(const Material& material) const = 0;
    /// Returns the values of all constants, in the order of the laws.
    [[nodiscard]] virtual std::vector<double> constants() const = 0;
    /// Returns the largest gap of a lasting contact, m.
    [[nodiscard]] virtual double beyond(double effective_radius) const = 0;
    /// Returns whether a near pair, or a particle near a wall, is a contact; completes the touch.
    [[nodiscard]] virtual bool begin(Touch<Partner::particle>& t, const double* memory) const = 0;
    [[nodiscard]] virtual bool begin(Touch<Partner::wall>& t, const double* memory) const = 0;
    /// Returns the forces for the present memory.
    [[nodiscard]] virtual Response<double> respond(const Touch<Partner::particle>& t, const double* memory) const = 0;
    [[nodiscard]] virtual Response<double> respond(const Touch<Partner::wall>& t, const double* memory) const = 0;
    /// Returns the forces of a time step and advances the memory by it.
    [[nodiscard]] virtual Response<double> advance(const Touch<Partner::particle>& t, double* memory) const = 0;
    [[nodiscard]] virtual Response<double> advance(const Touch<Partner::wall>& t, double* memory) const = 0;
    [[nodiscard]] virtual double energy(const Touch<Partner::particle>& t, const double* memory) const = 0;
    [[nodiscard]] virtual double energy(const Touch<Partner::wall>& t, const double* memory) const = 0;
    /// Returns the springs and dampers of the pair.
    [[nodiscard]] virtual Springs springs(const Touch<Partner::particle>& t) const = 0;
    [[nodiscard]] virtual Springs springs(const Touch<Partner::wall>& t) const = 0;

private:
    Traits traits_;
};

template <class C>
class ContactOf final : public AnyContact {
public:
    explicit ContactOf(const Material& m)
        : AnyContact({C::spin, C::rolls, C::reaches, C::acts_apart, C::remembers_separation, C::memory_kinds()}),
          material_(m),
          laws_(C::of(m)) {}
    bool covers(const Material& m) const override { return C::covers(m); }
    std::unique_ptr<const AnyContact> of(const Material& m) const override { return std::make_unique<ContactOf>(m); }
    std::vector<double> constants() const override { return C::values_of(material_); }
    double beyond(double effective_radius) const override { return C::beyond(material_, effective_radius); }
    bool begin(Touch<Partner::particle>& t, const double* memory) const override { return begun(t, memory); }
    bool begin(Touch<Partner::wall>& t, const double* memory) const override { return begun(t, memory); }
    Response<double> respond(const Touch<Partner::particle>& t, const double* memory) const override {
        return at_present(t, memory);
    }
    Response<double> respond(const Touch<Partner::wall>& t, const double* memory) const override {
        return at_present(t, memory);
    }
    Response<double> advance(const Touch<Partner::particle>& t, double* memory) const override {
        return laws_.template respond<true>(t, memory);
    }
    Response<double> advance(const Touch<Partner::wall>& t, double* memory) const override {
        return laws_.template respond<true>(t, memory);
    }
    double energy(const Touch<Partner::particle>& t, const double* memory) const override {
        return laws_.energy(t, memory);
    }
    double energy(const Touch<Partner::wall>& t, const double* memory) const override {
        return laws_.energy(t, memory);
    }
    Springs springs(const Touch<Partner::particle>& t) const override { return laws_.springs(t); }
    Springs springs(const Touch<Partner::wall>& t) const override { return laws_.springs(t); }

private:
    template <class T>
    bool begun(T& t, const double* memory) const {
        if constexpr (!C::reaches) return t.overlap > 0;
        laws_.begin(t, memory);
        return t.touching;
    }
    template <class T>
    Response<double> at_present(const T& t, const double* memory) const {
        typename C::Memory copy;
        std::copy_n(memory, copy.size(), copy.data());
        return laws_.template respond<false>(t, copy.data());
    }

    Material material_;
    C laws_;
};

}  // namespace grainsweep::dem
