#include "maps/map_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

/// A room: free inside, walls on the outer ring of cells.
OccupancyGrid room(int side, double resolution_m = 0.1, TPoint2D origin = {}) {
  OccupancyGrid grid({resolution_m, origin, side, side}, OccupancyGrid::kFree);
  for (int i = 0; i < side; ++i) {
    for (const Cell c : {Cell{i, 0}, Cell{i, side - 1}, Cell{0, i}, Cell{side - 1, i}}) {
      grid.at(c) = OccupancyGrid::kOccupied;
    }
  }
  return grid;
}

TEST(MapEvaluation, MapEqualToTheTruthIsPerfect) {
  const MapScores s = evaluate_map(room(20), room(20), {}, 0.0);
  EXPECT_EQ(s.precision, 1.0);
  EXPECT_EQ(s.recall, 1.0);
  EXPECT_EQ(s.free_iou, 1.0);
  EXPECT_EQ(s.judged_occupied_cells, 76u);
  EXPECT_EQ(s.true_occupied_cells, 76u);
  EXPECT_EQ(s.known_true_cells, 400u);
}

TEST(MapEvaluation, ShiftWithinTheToleranceIsForgiven) {
  const OccupancyGrid shifted = room(20, 0.1, {0.2, 0.0});
  EXPECT_EQ(evaluate_map(shifted, room(20), {}, 2.0).recall, 1.0);
  EXPECT_EQ(evaluate_map(shifted, room(20), {}, 2.0).precision, 1.0);
  EXPECT_LT(evaluate_map(shifted, room(20), {}, 1.0).recall, 0.7);
  EXPECT_DOUBLE_EQ(evaluate_map(shifted, room(20), {}, 2.0).tolerance_m, 0.2);
}

TEST(MapEvaluation, PoseBetweenTheGridsIsUndone) {
  // The same room, mapped by a rover that began at (1.3, 0.4) heading 90 degrees.
  const TPose2D truth_from_estimate{1.3, 0.4, kPi / 2.0};
  OccupancyGrid truth = room(20);
  truth.at({5, 9}) = OccupancyGrid::kOccupied;  // breaks the symmetry
  OccupancyGrid estimate({0.1, {-3.0, -3.0}, 60, 60});
  for (std::size_t i = 0; i < truth.cells.size(); ++i) {
    const TPoint2D p = truth.geometry.center_of(truth.geometry.cell_of(i));
    const TPoint2D q = transform(inverse(truth_from_estimate), p);
    estimate.at(estimate.geometry.cell_at(q)) = truth.cells[i];
  }
  const MapScores s = evaluate_map(estimate, truth, truth_from_estimate, 0.0);
  EXPECT_EQ(s.precision, 1.0);
  EXPECT_EQ(s.recall, 1.0);
  EXPECT_EQ(s.free_iou, 1.0);
  EXPECT_LT(evaluate_map(estimate, truth, {}, 1.0).recall, 0.9);
}

TEST(MapEvaluation, GhostsCostPrecisionAndGapsCostRecall) {
  OccupancyGrid estimate = room(20);
  for (int x = 5; x < 15; ++x) estimate.at({x, 10}) = OccupancyGrid::kOccupied;
  MapScores s = evaluate_map(estimate, room(20), {}, 1.0);
  EXPECT_DOUBLE_EQ(s.precision, 76.0 / 86.0);
  EXPECT_EQ(s.recall, 1.0);
  estimate = room(20);
  for (int x = 0; x < 20; ++x) estimate.at({x, 0}) = OccupancyGrid::kFree;
  s = evaluate_map(estimate, room(20), {}, 0.0);
  EXPECT_EQ(s.precision, 1.0);
  EXPECT_DOUBLE_EQ(s.recall, 56.0 / 76.0);
  EXPECT_DOUBLE_EQ(s.free_iou, 324.0 / 344.0);
}

TEST(MapEvaluation, WhatTheTruthDoesNotKnowIsNotJudged) {
  OccupancyGrid truth = room(20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 10; x < 20; ++x) truth.at({x, y}) = OccupancyGrid::kUnknown;
  }
  OccupancyGrid estimate = room(20);
  estimate.at({15, 10}) = OccupancyGrid::kOccupied;
  const MapScores s = evaluate_map(estimate, truth, {}, 1.0);
  EXPECT_EQ(s.precision, 1.0);
  EXPECT_EQ(s.recall, 1.0);
  EXPECT_EQ(s.free_iou, 1.0);
  // Walls right of the known half are skipped, but for the two next to true ones; and the ghost.
  EXPECT_EQ(s.skipped_occupied_cells, 76u - 38u - 2u + 1u);
  EXPECT_EQ(s.known_true_cells, 200u);
}

TEST(MapEvaluation, UnknownInTheEstimateIsNotFree) {
  const OccupancyGrid nothing({0.1, {}, 20, 20});
  const MapScores s = evaluate_map(nothing, room(20), {}, 2.0);
  EXPECT_EQ(s.free_iou, 0.0);
  EXPECT_EQ(s.recall, 0.0);
  EXPECT_EQ(s.precision, 0.0);
  EXPECT_EQ(s.judged_occupied_cells, 0u);
}

TEST(MapEvaluation, ToleranceOutOfRangeIsRefused) {
  EXPECT_THROW(evaluate_map(room(3), room(3), {}, -1.0), InputError);
  EXPECT_THROW(evaluate_map(room(3), room(3), {}, NAN), InputError);
  EXPECT_THROW(evaluate_map(room(3), room(3), {NAN, 0.0, 0.0}, 1.0), InputError);
}

}  // namespace
}  // namespace rovigo::maps
