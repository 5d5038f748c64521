#include "viewer/render/pixels.h"

#include <algorithm>
#include <cmath>

#include "viewer/render/scene.h"

namespace sgm::render {

void PixelSums::add(std::span<const Job> jobs, std::span<const std::array<float, 4>> colors) {
    for (size_t i = 0; i < jobs.size(); ++i)
        for (size_t c = 0; c < 4; ++c) rgba[index(jobs[i]) + c] += colors[i][c];
}

Image PixelSums::image() const {
    std::vector<float> means = rgba;
    for (size_t i = 0; i < means.size(); i += 4)
        for (size_t c = 0; c < 3; ++c) means[i + c] /= std::max(means[i + 3], 1.0f);
    return encode(means, width, height);
}

std::vector<uint8_t> PixelSums::bytes(int left, int top, int columns, int rows) const {
    std::vector<uint8_t> bytes(size_t(columns) * size_t(rows) * 4, 0);
    uint8_t* to = bytes.data();
    for (int y = top; y < top + rows; ++y)
        for (int x = left; x < left + columns; ++x, to += 4) {
            const float* sum = &rgba[(size_t(y) * size_t(width) + size_t(x)) * 4];
            if (sum[3] == 0) continue;
            const std::array<uint8_t, 3> rgb = encodePixel({sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]}, x, y);
            std::copy(rgb.begin(), rgb.end(), to);
            to[3] = 255;
        }
    return bytes;
}

std::vector<Job> firstSamples(int width, int height) {
    std::vector<Job> jobs;
    jobs.reserve(size_t(width) * size_t(height));
    for (int by = 0; by < height; by += 8)
        for (int bx = 0; bx < width; bx += 8)
            for (int y = by; y < std::min(by + 8, height); ++y)
                for (int x = bx; x < std::min(bx + 8, width); ++x)
                    jobs.push_back({static_cast<uint32_t>(x) | static_cast<uint32_t>(y) << 16, 0});
    return jobs;
}

std::vector<Job> edgeSamples(const std::vector<Job>& first, const PixelSums& sums, int samples) {
    constexpr float visible = 0.055f;  // of the square root of light, which is about what the eye sees
    const auto width = size_t(sums.width), height = size_t(sums.height);
    std::vector<bool> edge(width * height, false);
    const auto compare = [&](size_t a, size_t b) {
        float most = 0;
        for (size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(std::sqrt(sums.rgba[a * 4 + c]) - std::sqrt(sums.rgba[b * 4 + c])));
        if (most > visible) edge[a] = edge[b] = true;
    };
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x) {
            const size_t here = y * width + x;
            if (x + 1 < width) compare(here, here + 1);
            if (y + 1 < height) compare(here, here + width);
        }
    std::vector<Job> more;
    for (const Job& job : first)
        if (edge[job.y() * width + job.x()])
            for (uint32_t s = 1; s < static_cast<uint32_t>(samples); ++s) more.push_back({job.pixel, s});
    return more;
}

}  // namespace sgm::render
