// Pictures of a scene for ParaView and everything else that reads VTK: one VTP file per moment, and a PVD file that
// says when each of them is.
//
// VTP: XML poly data, one point per particle and one cell that shows them all; columns as appended raw binary, little
// endian, 32-bit floats, each block after its length in bytes (64 bits). https://docs.vtk.org, "VTK XML formats".
#pragma once

#include "solver/scenes/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::report {

/// The file's bytes. Columns of another length than the positions: std::invalid_argument.
[[nodiscard]] std::string vtp(const Snapshot& snapshot, double time);

class VtkSeries {
public:
    VtkSeries(std::filesystem::path folder, std::string name);

    /// Writes NAME_0000.vtp, NAME_0001.vtp, ..., then NAME.pvd anew, which names all so far. Makes the folder where
    /// there is none; the first moment takes away an older series of this name. Throws store::BrokenWorld where it
    /// cannot.
    void add(const Snapshot& snapshot, double time);
    [[nodiscard]] std::size_t size() const { return times_.size(); }
    [[nodiscard]] std::filesystem::path collection() const { return folder_ / (name_ + ".pvd"); }

private:
    [[nodiscard]] std::string file_of(std::size_t k) const;

    std::filesystem::path folder_;
    std::string name_;
    std::vector<double> times_;  ///< s
};

}  // namespace grainsweep::report
