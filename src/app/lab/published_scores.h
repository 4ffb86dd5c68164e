// Figures that were published for the benchmarks, to stand beside ours. Only what could be read at a source
// is here.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace splatcut {

struct PublishedScore {
  std::string benchmark, method, source;
  std::string iou, accuracy, seconds;  // as printed there, of 1; empty: not known to us
};

inline const std::vector<PublishedScore>& published_scores() {
  static const std::string kGaussianCut = "Jain et al., GaussianCut, NeurIPS 2024";
  static const std::vector<PublishedScore> scores = {
      {"NVOS", "GaussianCut", kGaussianCut, ".925", ".984", "88.8 on an RTX 4090"},
      {"NVOS", "GaussianCut without the cut (threshold)", kGaussianCut, ".912", "", "19.5 on an RTX 4090"},
      {"NVOS", "NVOS", "Ren et al., CVPR 2022", ".701", "", ""},
      {"SPIn-NeRF", "GaussianCut", kGaussianCut, ".929", "", ""},
      // Means over the ten scenes of README_MVSeg.txt, which comes with the masks.
      {"SPIn-NeRF", "SPIn-NeRF", "Mirzaei et al., CVPR 2023", ".909", ".988", ""},
  };
  return scores;
}

inline nlohmann::json published_json(const std::string& benchmark) {
  nlohmann::json list = nlohmann::json::array();
  for (const PublishedScore& p : published_scores())
    if (p.benchmark == benchmark)
      list.push_back({{"method", p.method},
                      {"source", p.source},
                      {"image_iou", p.iou},
                      {"accuracy", p.accuracy},
                      {"seconds", p.seconds}});
  return list;
}

}  // namespace splatcut
