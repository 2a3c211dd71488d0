// A powder as a file: material, sizes, contacts, what was measured of it. A campaign file that names one gets the
// parameters of its scene from it.
#pragma once

#include "solver/scenes/values.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::campaign {

struct ParameterSpace;

/// Sizes of a powder after its cut.
struct PowderSizes {
    std::string csv;                   ///< as size_file of the scenes reads it
    std::filesystem::path file;        ///< that has exactly these contents; empty: the program made them
    std::filesystem::path source;      ///< the file that "sizes" names; empty: none
    double d10 = 0, d50 = 0, d90 = 0;  ///< by volume, m
    double number_d10 = 0, number_d50 = 0, number_d90 = 0;
    double smallest = 0, largest = 0;     ///< m
    double cut_below = 0, cut_above = 0;  ///< shares of the mass that were cut off
};

struct Powder {
    std::string name;
    std::filesystem::path file;
    std::string text;                                ///< of the file
    std::shared_ptr<const nlohmann::json> document;  ///< as read
    std::optional<double> diameter;                  ///< where all are equal, m
    std::optional<PowderSizes> sizes;
    std::filesystem::path posterior;  ///< of a calibration; empty: none

    /// Diameter that stands for the powder: the one of all, or d50 by volume; none where it has no sizes.
    [[nodiscard]] std::optional<double> unit() const;
    /// What sizes that the program made are called: "ti64.json sizes".
    [[nodiscard]] std::string sizes_name() const;
};

/// A key of "material" or "contacts", as the scenes declare it.
[[nodiscard]] const ParameterSpec& powder_parameter(std::string_view name);
/// Reads and checks the text of a powder file; `read` gives the contents of files it names. Throws WrongQuestion with
/// the path and the rule.
[[nodiscard]] Powder powder_of(std::string text, const std::string& name,
                               const std::function<std::string(const std::string&)>& read);
/// Reads and checks a powder file and the files that it names beside it. Throws WrongQuestion naming the file, the path
/// and the rule.
[[nodiscard]] Powder read_powder(const std::filesystem::path& file);

/// What a powder gives a scene; parameters that a campaign gives itself stay as they are.
struct PowderUse {
    std::vector<std::string> set, overridden, unused;

    /// "sets density, friction; given by the campaign: ...; not used by this scene: ...".
    [[nodiscard]] std::string sentence() const;
};
/// Holds the parameters of the space's scene that the powder has and the space does not give. A scene without a file of
/// sizes gets the diameter alone. Throws WrongQuestion where a value does not fit the scene.
[[nodiscard]] PowderUse apply_powder(const Powder& powder, ParameterSpace& space);

/// What a material does with this powder under gravity, and what it costs.
struct PowderNumbers {
    double bond_number = 0;    ///< pull-off force over weight at the unit's diameter and 9.81 m/s2; 0: no cohesion
    double rayleigh_time = 0;  ///< of the smallest particle, s
    double time_step = 0;      ///< of the scenes at their default fraction and an impact speed of 1 m/s, s
    double seconds = 0;        ///< of one core, for 1,000 particles and 1 s
};
[[nodiscard]] PowderNumbers numbers_of(const Powder& powder);
/// Shares of volume and of number in classes of equal ratio, from the smallest size to the largest.
struct SizeClass {
    double from = 0, to = 0, volume = 0, number = 0;
};
[[nodiscard]] std::vector<SizeClass> size_classes(const PowderSizes& sizes, int count);

}  // namespace grainsweep::campaign
