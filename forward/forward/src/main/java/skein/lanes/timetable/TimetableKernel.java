package skein.lanes.timetable;

import skein.lanes.policy.LanePolicy;

/** Simulates many candidates in one episode, by its {@link Timetable}: teams of any size under any loop's
 * timing, with any vehicles that support timetables. {@code Rollout} with equal delays and an equal model is
 * its scalar reference.
 *
 * <p>Events have equal times in all lanes, so every time is a constant of the timetable. Allocates nothing
 * after construction, unless a timetable needs more slots than any before; one instance per thread.
 */
public final class TimetableKernel {
  public static final int WORLDS = LanePolicy.WORLDS;

  /** Kinds of operations in a timetable. */
  public static final int LOOK = 0, DECIDE = 1, ACT = 2, SCORE = 3, PREDICT = 4, EXPOSE = 5, JOIN = 6,
      ENTER = 7, END = 8;

  private final TimetableAgents[] agents;
  private final TimetableScores scores;
  private final boolean withVelocity;

  // Of the episode's timetable.
  private int[] operations, views;
  private int numbers;
  private float[] times, endAgesS;
  private Propagation[] propagations;
  private boolean readsVelocity;

  /** @param agents one per vehicle of the timetable, in its order */
  public TimetableKernel(TimetableAgents[] agents, TimetableScores scores) {
    this.agents = agents;
    this.scores = scores;
    boolean needsVelocity = false;
    for (TimetableAgents each : agents) needsVelocity |= each.needsVelocity();
    withVelocity = needsVelocity || scores.needsVelocity();
  }

  /** Simulates {@link #WORLDS} candidates in one episode, by the policies' parameters.
   *
   * @param timetable a timetable of an equal number of vehicles
   * @param worlds number of worlds that count, from the first
   */
  public void fly(Timetable timetable, int worlds) {
    start(timetable, worlds);
    for (int i = 0; i < timetable.size(); i++) perform(i);
  }

  public void start(Timetable timetable, int worlds) {
    if (timetable.vehicles() != agents.length)
      throw new IllegalArgumentException(
          "a timetable of " + timetable.vehicles() + " vehicles for " + agents.length);
    for (TimetableAgents each : agents) each.start(timetable, worlds);
    scores.start(worlds);
    operations = timetable.operations();
    views = timetable.views();
    numbers = timetable.numbers();
    times = timetable.times();
    endAgesS = timetable.endAgesS();
    propagations = timetable.propagations();
    // Predictions start from velocities, whatever policies use.
    readsVelocity = withVelocity || propagations.length > 0;
  }

  /** Executes one operation of the timetable. */
  public void perform(int operation) {
    int field = operation * Timetable.Fields(), number = operation * numbers;
    TimetableAgents agent = agents[operations[field + 1]];
    int first = operations[field + 2];
    switch (operations[field]) {
      case LOOK -> {
        boolean isMoving = readsVelocity && operations[field + 3] != 0;
        agent.vehicles.look(times, number, first * WORLDS, isMoving);
        if (operations[field + 4] >= 0)
          agent.vehicles.sense(
              (long) operations[field + 4] << 32 | operations[field + 5] & 0xffffffffL,
              first * WORLDS,
              isMoving);
      }
      case ACT -> agent.vehicles.act(times, number, agent.headings, first * WORLDS);
      case SCORE -> scores.score(agents, views, first * agents.length, times[number]);
      case END ->
          scores.end(
              agents,
              views,
              first * agents.length,
              times[number],
              times[number + 1],
              endAgesS,
              operations[field + 3]);
      case EXPOSE ->
          agent.expose(agents, views, first * agents.length, operations[field + 3], times, number);
      case JOIN -> agent.join(first, operations[field + 3] != 0, operations[field + 4]);
      case PREDICT ->
          agent.vehicles.predicted.predict(
              agent.vehicles.seen,
              agent.headings,
              first * WORLDS,
              operations[field + 3] * WORLDS,
              propagations[operations[field + 4]],
              withVelocity);
      case ENTER ->
          agent.vehicles.predicted.enter(
              agent.vehicles.seen,
              agent.headings,
              first < 0 ? -1 : first * WORLDS,
              operations[field + 3] * WORLDS,
              propagations[operations[field + 4]]);
      case DECIDE ->
          agent.decide(
              agents,
              views,
              first * agents.length,
              operations[field + 3] * WORLDS,
              operations[field + 4] * WORLDS,
              operations[field + 5] * WORLDS,
              times,
              number);
      default -> throw new IllegalStateException("no operation of a timetable: " + operations[field]);
    }
  }

  /** Lets the vehicle of a decision observe, without deciding. */
  public void observe(int operation) {
    int field = operation * Timetable.Fields();
    agents[operations[field + 1]].observe(
        agents,
        views,
        operations[field + 2] * agents.length,
        operations[field + 3] * WORLDS,
        operations[field + 4] * WORLDS,
        times,
        operation * numbers);
  }
}
