package skein.lanes;

import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import jdk.incubator.vector.VectorOperators;
import skein.forward.RolloutAgent;
import skein.lanes.loop.LaneAgents;
import skein.lanes.loop.LaneOffers;
import skein.lanes.loop.LaneVectors;
import skein.lanes.loop.LoopEye;
import skein.lanes.loop.LoopLanes;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.lanes.policy.VehicleNumbers;

/** One side of a duel in many worlds, each with its own delays. */
final class LoopOpponentAgents extends LaneAgents implements TeamMember {
  private static final int WORLDS = LanePolicy.WORLDS;

  private final LanePolicy policy;
  private final float startHeading;

  /** Sum of the changes of the decided headings, in each world, rad. */
  private final float[] effort = new float[WORLDS];

  private final LaneObservation observation = new LaneObservation(elapsedS);
  private final Directions known = new Directions(WORLDS);

  /** The camera that is the vehicle's only source about its opponent; null if it reads the opponent. */
  private LoopEye eye;

  LoopOpponentAgents(
      int self, RolloutAgent agent, LoopLanes loop, LaneDynamics model, LanePolicy policy) {
    super(self, loop, model.deadTimeS(), model.flights(agent, loop));
    this.policy = policy;
    startHeading = (float) agent.startHeadingRad();
    loop.carryForward(self, agent, vehicles);
  }

  @Override
  public void take(int world, VehicleNumbers numbers) {
    vehicles.place(world, numbers);
    policy.put(world, numbers);
  }

  @Override
  public float[] effortRad() {
    return effort;
  }

  /** Makes a camera the vehicle's only source about its opponent. */
  void seeBy(LoopEye eye) {
    this.eye = eye;
  }

  @Override
  public boolean sees() {
    return eye != null;
  }

  @Override
  public void startRow(int row) {
    super.startRow(row);
    if (eye != null) eye.startRow(row);
  }

  @Override
  public void start() {
    super.start();
    Arrays.fill(effort, 0f);
    for (Directions each : new Directions[] {sent, sentBefore, decided}) each.fill(0, WORLDS, startHeading);
    policy.start(startHeading, WORLDS);
  }

  @Override
  public boolean needsVelocity() {
    return policy.needsVelocity();
  }

  @Override
  public boolean needsAges() {
    return policy.needsAges();
  }

  @Override
  public void choose(LaneAgents[] all, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    if (policy.needsAges()) age(self, readAt, observation.ownAge);
    if (eye != null) believe(vectors);
    else see(all[1 - self], offers, vectors, readAt);
  }

  /** Decides from the camera's estimate of the opponent. */
  private void believe(LaneVectors vectors) {
    float[] own = seen();
    int from = seenFrom();
    eye.look(
        vectors,
        decides,
        own,
        from + LaneObservation.X * WORLDS,
        from + LaneObservation.Y * WORLDS,
        forecast == null ? null : forecast.actsS());
    observation.seeFromOwn(LaneObservation.X, eye.northM());
    observation.seeFromOwn(LaneObservation.Y, eye.eastM());
    if (policy.needsVelocity()) {
      observation.see(LaneObservation.VX, eye.northMps(), 0, own, from + LaneObservation.VX * WORLDS);
      observation.see(LaneObservation.VY, eye.eastMps(), 0, own, from + LaneObservation.VY * WORLDS);
    }
    if (policy.needsAges()) System.arraycopy(eye.ageS(), 0, observation.opponentAge, 0, WORLDS);
    policy.decide(observation, decided, 0, eye.heading(), 0, decidedNow, 0);
  }

  /** Decides from the readings of both vehicles. */
  private void see(LaneAgents opponents, LaneOffers offers, LaneVectors vectors, int[][] readAt) {
    for (int what = 0; what < LaneObservation.count(policy.needsVelocity(), false); what++) {
      int from = seenFrom() + what * WORLDS;
      observation.see(what, opponents.seen(), from, seen(), from);
    }
    if (policy.needsAges()) age(1 - self, readAt, observation.opponentAge);
    // The offer does not contain commands that the opponent sends after it.
    if (!together) opponents.knownAt(vectors, offers.joinedAt, opponents.sent, opponents.sentBefore, known);
    policy.decide(observation, decided, 0, together ? opponents.sent : known, 0, decidedNow, 0);
  }

  @Override
  public void remember(LaneVectors vectors, int endGrains) {
    policy.rememberBefore(decides, LaneOffers.NONE);
    IntVector none = IntVector.broadcast(INTS, LaneOffers.NONE), end = IntVector.broadcast(INTS, endGrains);
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      IntVector time = IntVector.fromArray(INTS, decides, i);
      FloatVector.fromArray(SPECIES, policy.heading, i)
          .blend(FloatVector.fromArray(SPECIES, policy.newHeading, i), time.compare(LT, none).cast(SPECIES))
          .intoArray(policy.heading, i);
      FloatVector.fromArray(SPECIES, effort, i)
          .add(FloatVector.fromArray(SPECIES, policy.turned, i), time.compare(LT, end).cast(SPECIES))
          .intoArray(effort, i);
    }
  }
}
