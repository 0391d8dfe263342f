package skein.lanes.policy;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.simd.LaneFunction;

/**
 * What the policies of many worlds see at a decision: see {@code skein.policy.HeadingPolicy}. Of the two
 * vehicles' readings it says where they stand: policies take the one from the other in their own pass.
 */
public final class LaneObservation {
  /** Worlds that decide together: few enough for the first-level cache. A multiple of every lane count. */
  public static final int WORLDS = LaneFunction.COUNT;

  /**
   * Of a reading: position, m, and velocity, m/s, north and east; velocities are told only to policies that
   * use them.
   */
  public static final int X = 0, Y = 1, VX = 2, VY = 3;

  public static final int READ = 4;

  private static final float[] ZEROS = new float[WORLDS];

  /** Where the readings of the opponent and the own ones begin, by what they tell. */
  public final float[][] opponent = new float[READ][], own = new float[READ][];

  public final int[] opponentAt = new int[READ], ownAt = new int[READ];

  /** Since the own last decision, s. */
  public final float[] elapsed;

  /** How old the readings are, s; kept only for policies that ask for it. */
  public final float[] ownAge = new float[WORLDS], opponentAge = new float[WORLDS];

  public LaneObservation() {
    this(new float[WORLDS]);
  }

  /**
   * @param elapsed kept by who observes
   */
  public LaneObservation(float[] elapsed) {
    this.elapsed = elapsed;
    Arrays.fill(opponent, ZEROS);
    Arrays.fill(own, ZEROS);
  }

  public void see(int what, float[] opponent, int opponentAt, float[] own, int ownAt) {
    // Nearly always the same ones: to store a reference costs the collector's bookkeeping.
    if (this.opponent[what] != opponent) this.opponent[what] = opponent;
    if (this.own[what] != own) this.own[what] = own;
    this.opponentAt[what] = opponentAt;
    this.ownAt[what] = ownAt;
  }

  /** What is known of the opponent from the own vehicle. */
  public void seeFromOwn(int what, float[] difference) {
    see(what, difference, 0, ZEROS, 0);
  }

  /** The opponent's reading minus the own one. */
  public void difference(int what, float[] into) {
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, opponent[what], opponentAt[what] + i)
          .sub(FloatVector.fromArray(SPECIES, own[what], ownAt[what] + i))
          .intoArray(into, i);
  }
}
