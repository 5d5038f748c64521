// Which samples a picture takes: every pixel once, then more where neighbours differ.
// Enters: a picture's size, or its pixels. Leaves: jobs for FieldScene. Assumes at most 65,535 pixels a side.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/render/draw.h"

namespace sgm::render {

/// One sample of one pixel, as the shaders read it. Sample 0 is the pixel's centre.
struct Job {
    uint32_t pixel;  ///< x | y << 16, from the top left
    uint32_t sample;
    size_t x() const { return pixel & 0xffffu; }
    size_t y() const { return pixel >> 16; }
    /// As `samplePosition` of the shaders (jobs.glsl), pixels from the top left.
    PicturePlace place() const {
        const double u = 0.5 + sample * 0.7548776662, v = 0.5 + sample * 0.5698402910;
        return {static_cast<double>(x()) + u - std::floor(u), static_cast<double>(y()) + v - std::floor(v)};
    }
};

/// The sum of the samples of every pixel: display light and their count, four floats a pixel, top row first.
struct PixelSums {
    int width = 0, height = 0;
    std::vector<float> rgba;

    PixelSums() = default;
    PixelSums(int width, int height) : width(width), height(height), rgba(size_t(width) * size_t(height) * 4, 0.0f) {}
    size_t index(Job job) const { return (job.y() * size_t(width) + job.x()) * 4; }
    /// Adds a colour a job.
    void add(std::span<const Job> jobs, std::span<const std::array<float, 4>> colors);
    /// Means as 8-bit sRGB.
    Image image() const;
    /// The same for a part of it as RGBA, transparent where there is no sample yet; (left, top) from the top left.
    std::vector<uint8_t> bytes(int left, int top, int columns, int rows) const;
};

/// Every pixel once, in blocks of 8 × 8 so that neighbours run together.
std::vector<Job> firstSamples(int width, int height);

/// Samples 1 … samples − 1 of every pixel in `first` that differs from a neighbour enough to be seen
/// (Whitted 1980's adaptive sampling, on display light).
std::vector<Job> edgeSamples(const std::vector<Job>& first, const PixelSums& sums, int samples);

}  // namespace sgm::render
