package skein.lanes;

/** What kernels that fly duels tell of the worlds flown last. */
abstract class DuelKernel {
  /** Worlds flown together. */
  public static final int WORLDS = LanePolicy.WORLDS;

  /** Distances, m: the smallest, the mean, and the mean of the last 10 s. */
  public final float[] minDistance = new float[WORLDS],
      meanDistance = new float[WORLDS],
      meanLast10s = new float[WORLDS];

  /** When the distance first was within the capture radius, s; infinite where it never was. */
  public final float[] captureS = new float[WORLDS];

  /** The sums of all changes of the commanded headings, by the shorter way, rad. */
  public final float[] pursuerEffortRad = new float[WORLDS], evaderEffortRad = new float[WORLDS];
}
