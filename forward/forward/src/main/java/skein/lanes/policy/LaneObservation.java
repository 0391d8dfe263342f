package skein.lanes.policy;

import java.util.Arrays;
import skein.simd.LaneFunction;

/** The observations of many worlds' policies at a decision: see {@link OpponentFormula}. Refers to
 * the two vehicles' readings by their offsets; policies subtract one from the other in their own pass.
 */
public final class LaneObservation {
  /** Number of worlds that decide together: fits the first-level cache. A multiple of every lane count. */
  public static final int WORLDS = LaneFunction.COUNT;

  /** Rows of a reading: position, m, and velocity, m/s, north and east; velocities are only filled for
   * policies that use them.
   */
  public static final int X = 0, Y = 1, VX = 2, VY = 3;

  public static final int READ = 4;

  /** Rows of a reading in space: position and velocity down follow those rows. */
  public static final int DOWN = 4, DOWN_MPS = 5, IN_SPACE = 6;

  /** Number of rows that are read, from {@link #X} on. */
  public static int count(boolean withVelocity, boolean inSpace) {
    // In space, velocities are always read.
    return inSpace ? IN_SPACE : withVelocity ? READ : VX;
  }

  private static final float[] ZEROS = new float[WORLDS];

  /** Offsets of the opponent's readings and of this vehicle's, indexed by row. */
  public final float[][] opponent = new float[READ][], own = new float[READ][];

  public final int[] opponentAt = new int[READ], ownAt = new int[READ];

  public final float[] elapsed;

  /** Ages of the readings, s; filled only for policies that use them. */
  public final float[] ownAge = new float[WORLDS], opponentAge = new float[WORLDS];

  public LaneObservation() {
    this(new float[WORLDS]);
  }

  /** @param elapsed time since the previous decision, s; maintained by the caller */
  public LaneObservation(float[] elapsed) {
    this.elapsed = elapsed;
    Arrays.fill(opponent, ZEROS);
    Arrays.fill(own, ZEROS);
  }

  public void see(int what, float[] opponent, int opponentAt, float[] own, int ownAt) {
    // Nearly always unchanged; storing a reference would cost the collector's bookkeeping.
    if (this.opponent[what] != opponent) this.opponent[what] = opponent;
    if (this.own[what] != own) this.own[what] = own;
    this.opponentAt[what] = opponentAt;
    this.ownAt[what] = ownAt;
  }

  /** The opponent's state relative to this vehicle, which is at 0. */
  public void seeFromOwn(int what, float[] difference) {
    see(what, difference, 0, ZEROS, 0);
  }
}
