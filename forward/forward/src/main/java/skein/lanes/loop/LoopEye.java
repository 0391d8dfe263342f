package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.GT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.DelayTable;
import skein.forward.RolloutAgent;
import skein.forward.ImageTiming;
import skein.forward.Nanos;
import skein.forward.TabledDelays;
import skein.lanes.policy.CameraTrackerLanes;
import skein.lanes.policy.LanePolicy;
import skein.lanes.timetable.ImageSource;

/** A camera in many worlds. Its images are taken and become known at different times in each world, which
 * {@link ImageSource}s compute. An image is simulated only when the vehicles' flight until then is known: at
 * the next decision, or some time later. The camera keeps its direction until a decision.
 */
public class LoopEye extends CameraTrackerLanes {
  private static final int WORLDS = LanePolicy.WORLDS, NONE = LaneOffers.NONE;
  private static final int IMAGE = CameraTrackerLanes.Detection(), BELIEF = CameraTrackerLanes.Belief();
  private static final int RING = ImageTiming.Ring(), GRAIN_NS = DelayTable.GrainNs();
  private static final LaneVectors ALL = LaneVectors.all();

  /** Maximum number of images per world that one pass takes, and that become known in one pass. */
  private static final int MOST = 8;

  private final ImageSource[] sources = new ImageSource[WORLDS];
  private final LaneVehicles ours, theirs;
  private final long periodNs;

  /** Start of the period, ns since the episode's start. */
  private long beginNs;

  private int row;

  // The images taken in one pass, by world: how many; and for each its number, its time, its errors, and
  // whether an opponent in view is detected.
  private final int[] takes = new int[WORLDS];
  private final int[][] taken = new int[MOST][WORLDS];
  public final long[][] takenNs = new long[MOST][WORLDS];
  private final float[][] bearings = new float[MOST][WORLDS], ranges = new float[MOST][WORLDS];
  public final boolean[][] isFound = new boolean[MOST][WORLDS];

  // The images that become known in one pass, by world: how many; and for each its number, and the newer
  // image that was added before it, or -1.
  private final int[] knows = new int[WORLDS];
  private final int[][] known = new int[MOST][WORLDS], newer = new int[MOST][WORLDS];

  /** Results of each world's images, by image number modulo {@link #RING}, and when each was taken, s. */
  private final float[] images = new float[RING * IMAGE * WORLDS], imagesS = new float[RING * WORLDS];

  private final LaneVectors some = new LaneVectors();

  // Images that are taken together: their times, the positions of both vehicles, and the results.
  private final int[] at = new int[WORLDS];
  public final float[] ourX = new float[WORLDS],
      ourY = new float[WORLDS],
      theirX = new float[WORLDS],
      theirY = new float[WORLDS],
      shown = new float[IMAGE * WORLDS];

  // Images that become known together: 1 in worlds with one, and 1 where a newer image was added before it;
  // that newer image; and the estimate before them, after the first and after both.
  private final int[] enters = new int[WORLDS], isOlder = new int[WORLDS];
  private final float[] newerShown = new float[IMAGE * WORLDS], newerS = new float[WORLDS];
  private final float[] from = new float[BELIEF * WORLDS],
      reached = new float[BELIEF * WORLDS],
      replayed = new float[BELIEF * WORLDS];

  /** Time before a period's start up to which all images have been taken, in grains; negative. */
  private final int[] longAgo = new int[WORLDS];

  /** @param own the agent with the camera
   * @param ours the controllers of that agent's vehicles, in all worlds
   */
  public LoopEye(
      CameraTrackerLanes.Forms forms,
      RolloutAgent own,
      RolloutAgent opponent,
      LoopLanes loop,
      LaneAgents ours,
      LaneAgents theirs) {
    super(forms, own, opponent);
    this.ours = ours.vehicles;
    this.theirs = theirs.vehicles;
    periodNs = Nanos.of(loop.periodS());
    for (int world = 0; world < WORLDS; world++)
      sources[world] = ImageSource.apply(own.eye().get(), ours.self, loop.durationS());
    Arrays.fill(longAgo, -LaneViews.grains(Math.min(loop.periodS(), LaneFlights.MOST_PIECE_S)));
  }

  /** Resets to the start of an episode with these worlds. */
  public void start(int[] worldKeys, TabledDelays[] links) {
    forget();
    row = 0;
    beginNs = 0;
    for (int world = 0; world < WORLDS; world++) sources[world].begin(worldKeys[world], links[world]);
  }

  /** Moves to a period; periods are processed in order. Takes the images whose vehicles' flight would
   * otherwise be discarded.
   */
  public void startRow(int number) {
    row = number;
    beginNs = row * periodNs;
    see(ALL, longAgo);
  }

  /** Fills in the estimates for decisions, and points the camera at them in worlds with a decision.
   *
   * @param decides time of the decision, in grains from the period's start; {@link LaneOffers#NONE} in worlds
   *   without one
   * @param own estimated positions of the vehicles with the camera: north from {@code x} on, east from {@code
   *   y} on
   * @param actsS time until the decision takes effect, if {@code own} is predicted for that moment; else null
   */
  public void look(LaneVectors vectors, int[] decides, float[] own, int x, int y, float[] actsS) {
    see(vectors, decides);
    float[] nowS = nowS(), aheadS = aheadS(), axis = axis();
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++)
        if (decides[i] != NONE) {
          nowS[i] = seconds(timeNs(decides[i]));
          aheadS[i] = actsS == null ? -1f : actsS[i];
        }
    decideUpon(own, x, own, y);
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++)
        if (decides[i] != NONE) axis[i] = newAxis()[i];
  }

  private long timeNs(int grains) {
    return beginNs + (long) grains * GRAIN_NS;
  }

  private static float seconds(long ns) {
    return (float) (ns * 1e-9);
  }

  /** Takes and evaluates all images up to given moments. The camera does not turn between decisions, so all
   * images are taken before any is evaluated.
   *
   * @param until the moments, in grains from the period's start; {@link LaneOffers#NONE} in worlds that stay
   *   unchanged
   */
  private void see(LaneVectors vectors, int[] until) {
    boolean more = true;
    while (more) {
      more = gather(vectors, until);
      for (int n = 0; find(vectors, takes, n); n++) take(n);
      for (int n = 0; find(vectors, knows, n); n++) join(n);
    }
  }

  /** Collects the images that are taken and that become known in one pass.
   *
   * @return whether there may be more
   */
  private boolean gather(LaneVectors vectors, int[] until) {
    boolean more = false;
    for (int k = 0; k < vectors.count; k++)
      for (int i = vectors.first[k], end = i + LANES; i < end; i++) {
        ImageSource source = sources[i];
        takes[i] = 0;
        knows[i] = 0;
        if (until[i] == NONE) continue;
        long untilNs = timeNs(until[i]);
        while (source.atNs() <= untilNs && takes[i] + knows[i] < MOST) {
          if (source.isTaken()) {
            int n = takes[i]++;
            taken[n][i] = source.image() % RING;
            takenNs[n][i] = source.atNs();
            bearings[n][i] = source.bearing();
            ranges[n][i] = source.range();
            isFound[n][i] = source.isFound();
          } else {
            int n = knows[i]++;
            known[n][i] = source.image() % RING;
            newer[n][i] = source.order().isOlder() ? source.order().last() % RING : -1;
          }
          source.next();
        }
        more |= takes[i] + knows[i] == MOST;
      }
    return more;
  }

  /** Selects the vectors in which some world's count exceeds {@code n}.
   *
   * @return whether there is one
   */
  private boolean find(LaneVectors vectors, int[] counts, int n) {
    some.count = 0;
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      if (IntVector.fromArray(INTS, counts, i).compare(GT, n).anyTrue()) some.first[some.count++] = i;
    }
    return some.count > 0;
  }

  /** Takes each world's n-th image of this pass. */
  private void take(int n) {
    for (int k = 0; k < some.count; k++)
      for (int i = some.first[k], end = i + LANES; i < end; i++)
        at[i] = takes[i] > n ? (int) Math.ceilDiv(takenNs[n][i] - beginNs, GRAIN_NS) : NONE;
    ours.look(row, some, at, ourX, ourY);
    theirs.look(row, some, at, theirX, theirY);
    System.arraycopy(bearings[n], 0, bearing(), 0, WORLDS);
    System.arraycopy(ranges[n], 0, range(), 0, WORLDS);
    detect(ourX, ourY, 0, theirX, theirY, 0, shown);
    for (int k = 0; k < some.count; k++)
      for (int i = some.first[k], end = i + LANES; i < end; i++) if (takes[i] > n) keep(n, i);
  }

  /** Stores the result of the n-th image that a world takes in this pass. */
  public void keep(int n, int world) {
    int image = taken[n][world], to = image * IMAGE * WORLDS + world;
    for (int number = 0; number < IMAGE * WORLDS; number += WORLDS) images[to + number] = shown[world + number];
    if (!isFound[n][world]) images[to] = 0;
    imagesS[image * WORLDS + world] = seconds(takenNs[n][world]);
  }

  /** Updates the estimate by each world's n-th image that becomes known in this pass. */
  private void join(int n) {
    float[] takenS = takenS();
    boolean anyOlder = false;
    for (int k = 0; k < some.count; k++)
      for (int i = some.first[k], end = i + LANES; i < end; i++) {
        boolean does = knows[i] > n, older = does && newer[n][i] >= 0;
        enters[i] = does ? 1 : 0;
        isOlder[i] = older ? 1 : 0;
        anyOlder |= older;
        if (does) recall(i, known[n][i], shown, takenS);
        if (older) recall(i, newer[n][i], newerShown, newerS);
      }
    if (anyOlder) {
      blend(newest(), before(), from);
      join(from, shown, reached);
      System.arraycopy(newerS, 0, takenS, 0, WORLDS);
      join(reached, newerShown, replayed);
    } else join(newest(), shown, reached);
    enter();
  }

  private void recall(int world, int image, float[] into, float[] intoS) {
    int at = image * IMAGE * WORLDS + world;
    for (int number = 0; number < IMAGE * WORLDS; number += WORLDS) into[number + world] = images[at + number];
    intoS[world] = imagesS[image * WORLDS + world];
  }

  /** Copies one estimate, but in worlds where an older image is added copies the other. */
  private void blend(float[] belief, float[] whereOlder, float[] into) {
    for (int k = 0; k < some.count; k++) {
      int i = some.first[k];
      VectorMask<Float> older = IntVector.fromArray(INTS, isOlder, i).compare(GT, 0).cast(SPECIES);
      for (int number = i; number < into.length; number += WORLDS)
        FloatVector.fromArray(SPECIES, belief, number)
            .blend(FloatVector.fromArray(SPECIES, whereOlder, number), older)
            .intoArray(into, number);
    }
  }

  private void enter() {
    float[] newest = newest(), before = before();
    for (int k = 0; k < some.count; k++) {
      int i = some.first[k];
      VectorMask<Float> does = IntVector.fromArray(INTS, enters, i).compare(GT, 0).cast(SPECIES),
          older = IntVector.fromArray(INTS, isOlder, i).compare(GT, 0).cast(SPECIES);
      for (int number = i; number < newest.length; number += WORLDS) {
        FloatVector held = FloatVector.fromArray(SPECIES, newest, number),
            one = FloatVector.fromArray(SPECIES, reached, number),
            both = FloatVector.fromArray(SPECIES, replayed, number);
        FloatVector.fromArray(SPECIES, before, number)
            .blend(held.blend(one, older), does)
            .intoArray(before, number);
        held.blend(one.blend(both, older), does).intoArray(newest, number);
      }
    }
  }
}
