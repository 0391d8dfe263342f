package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.RolloutAgent;
import skein.lanes.plant.PlantLanes;
import skein.lanes.plant.PlantPieces;
import skein.lanes.policy.Directions;
import skein.simd.BoundFunction;
import skein.simd.LaneCall;
import skein.vehicle.Plant;

/** Vehicles that move according to a {@link Plant}, whose commands take effect at different times in each
 * world. A piece is one step of the plant; {@link PlantPieces} defines its stored components. Before the
 * first command the vehicle rests. The scalar reference is {@code skein.forward.PlantVehicle}.
 */
public final class PlantFlights extends LaneFlights {
  private final int firstOfState;

  private final PlantLanes lanes;
  private final int[] starts;
  private final LaneCall flown, position, look;

  /** Computes {@link #flown} from slot to slot; its pieces are one input, of this index. */
  private final LaneCall next;

  private final int present;

  /** The state at the end of the simulated pieces. */
  private final float[] reached;

  /** Whether the plant itself has a vertical part. */
  private final boolean climbs;

  /** @param inSpace whether commands and readings have a vertical part, even if the plant has none */
  public PlantFlights(RolloutAgent agent, PlantLanes lanes, LoopLanes loop, boolean inSpace) {
    super(
        agent,
        lanes.pieces().kept(),
        lanes.plant().stepS(),
        lanes.plant().deadTimeS(),
        loop,
        inSpace);
    climbs = lanes.inSpace();
    PlantPieces pieces = lanes.pieces();
    this.lanes = lanes;
    firstOfState = pieces.firstOfState() * WORLDS;
    starts = pieces.starts();
    reached = new float[lanes.count() * WORLDS];
    float[] parameters = pieces.parametersOf(lanes.plant(), agent.speed());
    flown = bound(pieces.flown(), parameters);
    flown.output(0, reached, 0, 0);
    next = bound(pieces.flown(), parameters);
    present = pieces.flown().inputs()[0] == PlantPieces.Since() ? 1 : 0;
    position = bound(pieces.position(), parameters);
    look = bound(pieces.look(), parameters);
  }

  private LaneCall bound(BoundFunction of, float[] parameters) {
    LaneCall call = new LaneCall(of, parameters);
    for (int place = 0; place < of.inputs().length; place++)
      call.input(place, of.inputs()[place] == PlantPieces.Since() ? sinceS : chosen, 0, 0);
    return call;
  }

  @Override
  boolean climbs() {
    return climbs;
  }

  @Override
  void rest(float[] pieces) {
    if (climbs) lanes.restInSpace(pieces, firstOfState, startZ);
    else lanes.rest(pieces, firstOfState);
    Arrays.fill(pieces, ALONG_X, ALONG_X + WORLDS, PlantPieces.Rests());
    for (int axis = 0; axis < 2; axis++)
      for (int world = 0; world < WORLDS; world++)
        pieces[starts[axis] * WORLDS + world] += state[(axis == 0 ? X : Y) + world];
  }

  @Override
  public void fly(float[] into, int at, boolean withVelocity) {
    if (climbs && at == X) {
      position.output(0, into, X, 0);
      position.output(1, into, Y, 0);
      position.output(2, into, Z, 0);
      position.apply();
    } else {
      LaneCall call = withVelocity || climbs ? look : position;
      call.output(0, into, at, 0);
      call.apply();
    }
  }

  @Override
  void flyOn(int count) {
    flown.use(count * LANES);
    flown.apply();
  }

  @Override
  void flyOn(int from, int to) {
    next.input(present, pieces, from, 0);
    next.output(0, pieces, to + firstOfState, 0);
    next.apply();
    int after = firstOfState + reached.length;
    System.arraycopy(pieces, from, pieces, to, firstOfState);
    System.arraycopy(pieces, from + after, pieces, to + after, chosen.length - after);
  }

  @Override
  void begin(LaneVectors vectors, int at, int[] acts, Directions commanded) {
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE);
    int flown = firstOfState + reached.length, size = chosen.length;
    for (int k = 0; k < vectors.count; k++) {
      int from = k * LANES, i = vectors.first[k], to = at + i;
      VectorMask<Float> does = IntVector.fromArray(INTS, acts, i).compare(LT, none).cast(SPECIES);
      if (commanded == null) copy(0, firstOfState, from, to);
      else {
        command(commanded.cos, ALONG_X, i, from, to, does);
        command(commanded.sin, ALONG_Y, i, from, to, does);
        if (climbs) {
          command(commanded.third, THIRD, i, from, to, does);
          command(commanded.holds, HOLDS, i, from, to, does);
        }
      }
      for (int number = firstOfState; number < flown; number += WORLDS)
        FloatVector.fromArray(SPECIES, chosen, number + from)
            .blend(FloatVector.fromArray(SPECIES, reached, number - firstOfState + from), does)
            .intoArray(pieces, to + number);
      copy(flown, size, from, to);
    }
  }

  private void command(float[] commanded, int number, int i, int from, int to, VectorMask<Float> does) {
    FloatVector.fromArray(SPECIES, chosen, number + from)
        .blend(FloatVector.fromArray(SPECIES, commanded, i), does)
        .intoArray(pieces, to + number);
  }

  private void copy(int first, int end, int from, int to) {
    for (int number = first; number < end; number += WORLDS)
      FloatVector.fromArray(SPECIES, chosen, number + from).intoArray(pieces, to + number);
  }
}
