package skein.planning;

import java.util.Arrays;

/**
 * The way of one vehicle for each candidate of a block: positions, m, and velocities, m/s, north and
 * east, at the start and at the end of each step; by row, then by candidate. The start is row 0.
 */
final class BlockWay {
  static final int SIZE = CandidateBlock.Size();

  final float[] x, y, vx, vy;

  BlockWay(int steps) {
    int count = (steps + 1) * SIZE;
    x = new float[count];
    y = new float[count];
    vx = new float[count];
    vy = new float[count];
  }

  /** All start alike; positions are counted from {@code origin}. */
  void start(Motion motion, Motion origin) {
    fill(0, motion.x() - origin.x(), motion.y() - origin.y(), motion.vx(), motion.vy());
  }

  void fill(int row, double north, double east, double northMps, double eastMps) {
    int from = row * SIZE, to = from + SIZE;
    Arrays.fill(x, from, to, (float) north);
    Arrays.fill(y, from, to, (float) east);
    Arrays.fill(vx, from, to, (float) northMps);
    Arrays.fill(vy, from, to, (float) eastMps);
  }
}
