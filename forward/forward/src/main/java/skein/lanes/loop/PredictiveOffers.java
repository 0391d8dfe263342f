package skein.lanes.loop;

import static jdk.incubator.vector.VectorOperators.EQ;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;

import java.util.Arrays;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.forward.LoopTiming;
import skein.forward.TabledDelays;

/** The {@code predictive} loop: every vehicle is read once a period, and half-way between two requests all
 * vehicles are offered what is known at that time. Answers enter a {@link LaneForecast} in the order of their
 * arrival.
 */
final class PredictiveOffers extends LaneOffers {
  private final LaneForecast forecast;
  private final PeriodicRequests requests;
  private final int periodGrains, due;

  /** The oldest period whose requests may have pending answers. */
  private int oldest;

  private int row;

  // The taken answers: their code, from period and vehicle; the vehicle; and the times of request, reading
  // and answer.
  private final int[] found = new int[WORLDS],
      whose = new int[WORLDS],
      askedAt = new int[WORLDS],
      madeAt = new int[WORLDS],
      receivedAt = new int[WORLDS];

  /** Vectors in which some world may have pending answers. */
  private final LaneVectors searching = new LaneVectors();

  private boolean more;

  /** @param maxDelayS the longest one-way delay of any link */
  PredictiveOffers(
      LoopTiming.Predictive timing,
      int vehicles,
      double maxDelayS,
      LaneForecast forecast,
      MissingReadings missing) {
    super(vehicles, new LaneDelays(), missing, true, 0);
    this.forecast = forecast;
    double periodS = timing.periodS();
    periodGrains = LaneViews.grains(periodS);
    due = forecast.dueGrains;
    requests = new PeriodicRequests(periodS, timing.asking(), vehicles, maxDelayS, delays, missing);
    keepOffers(new int[WORLDS]);
    Arrays.fill(nextAt, due + periodGrains);
    for (int v = 0; v < vehicles; v++) fresh[v] = forecast.track(v).fresh;
  }

  @Override
  void start(int[] worldKeys, TabledDelays[] links) {
    delays.start(worldKeys, links);
    requests.start(links);
    forecast.start();
    oldest = 0;
  }

  @Override
  void startRow(int number) {
    row = number;
    forecast.startRow(row);
    requests.ask(row);
    searching.takeAll();
    Arrays.fill(found, -1);
    while (take()) forecast.enter(searching, whose, askedAt, madeAt, receivedAt);
    while (oldest < row && isEmpty(requests.answered, requests.slot(oldest))) oldest++;
    forecast.tell(joinedAt, sampledAt);
    more = true;
  }

  @Override
  boolean nextBeat() {
    boolean first = more;
    more = false;
    return first;
  }

  /** Takes the next answer of each world that arrives before the decision is due.
   *
   * @return whether there was one
   */
  private boolean take() {
    IntVector none = IntVector.broadcast(INTS, NONE),
        known = IntVector.broadcast(INTS, due),
        beyond = IntVector.broadcast(INTS, due + 1),
        no = IntVector.broadcast(INTS, -1),
        within = IntVector.broadcast(INTS, due - periodGrains);
    int kept = 0;
    for (int k = 0; k < searching.count; k++) {
      int i = searching.first[k];
      IntVector taken = IntVector.fromArray(INTS, found, i);
      no.intoArray(found, i);
      no.intoArray(whose, i);
      beyond.intoArray(receivedAt, i);
      boolean any = false;
      for (int step = oldest; step <= row; step++) {
        int slot = requests.slot(step), shift = (step - row) * periodGrains;
        for (int v = 0; v < vehicles; v++) {
          int code = step * vehicles + v;
          int[] answers = requests.answered[v][slot];
          IntVector answer = IntVector.fromArray(INTS, answers, i);
          answer = answer.blend(none, taken.compare(EQ, code));
          answer.intoArray(answers, i);
          // No overflow, because the shift is not positive.
          answer = answer.add(shift);
          IntVector first = IntVector.fromArray(INTS, receivedAt, i);
          VectorMask<Integer> sooner = answer.compare(LT, first);
          if (sooner.anyTrue()) {
            IntVector made = IntVector.fromArray(INTS, requests.read[v][slot], i).add(shift);
            sooner = sooner.andNot(answer.compare(EQ, known).andNot(made.compare(LT, within)));
            any |= sooner.anyTrue();
            first.blend(answer, sooner).intoArray(receivedAt, i);
            IntVector.fromArray(INTS, found, i).blend(code, sooner).intoArray(found, i);
            IntVector.fromArray(INTS, whose, i).blend(v, sooner).intoArray(whose, i);
            IntVector.fromArray(INTS, madeAt, i).blend(made, sooner).intoArray(madeAt, i);
            IntVector.fromArray(INTS, askedAt, i)
                .blend(IntVector.fromArray(INTS, requests.asked[v][slot], i).add(shift), sooner)
                .intoArray(askedAt, i);
          }
        }
      }
      if (any) searching.first[kept++] = i;
    }
    searching.count = kept;
    return kept > 0;
  }
}
