// Labels of a scene as a file: a byte for each row of the file that the scene was read from, 0 for rows that
// the scene lacks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/formats/scene_file.h"

namespace splatcut {

// labels: per Gaussian of the scene.
std::string labels_in_file_order(const Scene& scene, const std::vector<std::uint8_t>& labels);

// A path that ends with .npy holds them as numpy does, else the bytes alone. Throws Error as AtomicFile does.
void write_labels(const std::filesystem::path& path, const Scene& scene,
                  const std::vector<std::uint8_t>& labels);

// Of a file of bytes alone: per Gaussian of the scene, 1 where its row has any label. Throws Error for
// another number of rows.
std::vector<std::uint8_t> load_labels(const std::filesystem::path& path, const Scene& scene);

// What the numbers of labels and of object_id stand for, as JSON: the objects' names, the first has number 1.
void write_object_names(const std::filesystem::path& path, std::span<const std::string> names);
// Throws Error where the file is there and holds anything else: nobody who writes over a scene means, say,
// the cameras beside it.
void refuse_other_than_names(const std::filesystem::path& path);

}  // namespace splatcut
