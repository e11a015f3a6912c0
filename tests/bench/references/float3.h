// Three floats side by side, as people write images by themselves.
#pragma once

namespace quell::bench {

struct Float3 {
  float x, y, z;
};
inline Float3 operator-(const Float3& a, const Float3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Float3 operator+(const Float3& a, const Float3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Float3 operator*(const Float3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Float3 operator/(const Float3& a, float s) { return {a.x / s, a.y / s, a.z / s}; }
inline float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace quell::bench
