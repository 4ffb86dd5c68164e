// Positions as whole numbers of 24 bits: how fine they become.
//
// All have one step, 2^-bits units, so that the coordinate that is farthest from 0 decides for all: a single
// stray can make the others coarse. What is said here names it.
#pragma once

#include <span>
#include <string>

#include "scene/cloud/gaussian_cloud.h"

namespace splatcut {

struct FixedSteps {
  int bits = 12;                 // behind the point
  float farthest = 0, size = 0;  // the farthest coordinate; the middle one of the Gaussians' sizes
  // The few farthest, without which all others would have finer steps: how many, and how far the others
  // reach.
  std::size_t strays = 0;
  float others = 0;

  FixedSteps(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians);

  float step() const;
  float rounded(float coordinate) const;  // in steps

  // Throws Error, on the format, for what 24 bits cannot hold, and where half of the Gaussians are smaller
  // than a step.
  void check(const char* format, const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) const;
  // Clause on Gaussians that move by more than half their size, and on the strays whose fault that is; or
  // empty.
  std::string moved(const GaussianCloud& cloud, std::span<const std::uint32_t> gaussians) const;

 private:
  std::string whose_fault() const;
};

}  // namespace splatcut
