package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts a vehicle whose commands are unknown, by samples of its next turns, each simulated with a model
  * of the vehicle. Its commanded velocity is assumed to turn at one of [[TurnRates.Each]] for a time, and
  * then at another.
  *
  * From velocities and tilts, an extended Kalman filter estimates the commanded velocity: a vehicle that is
  * commanded to turn tilts before its path bends. [[TurnRates]] estimates its turn rate. A prediction is the
  * mean of the samples, which minimises the expected squared error.
  *
  * [[ConstantTurn]] is evaluated too, and predicts as long as its velocity errors over the last
  * [[TurnBelief.MemoryS]] are not larger. So a vehicle that is commanded otherwise is predicted no worse than
  * by that.
  *
  * @param model a model of the vehicle, which follows commanded velocities
  */
final class TurnBelief[S](model: VehicleModel[S]) extends VehicleModel[TurnBelief.Believed[S]]:
  import TurnBelief.*

  def start(seen: Kinematics): Believed[S] =
    val command = commandOf(seen)
    val turns   = TurnRates.of(Command.of(command).heading)
    sampled(Believed(
      command,
      turns,
      0,
      same(model.start(seen)),
      Vector.empty,
      ConstantTurn.start(seen),
      0,
      0
    ))

  /** The commanded velocity at first: the vehicle's own velocity, with the maximum uncertainty. */
  private def commandOf(seen: Kinematics): ParameterBelief =
    ParameterBelief(MostOffMps)
      .copy(mean = Vector(seen.velocityNed.x, seen.velocityNed.y, seen.velocityNed.z))

  def advanced(state: Believed[S], setpoint: Setpoint, span: Span): Believed[S] =
    val rate = state.turns.mean
    val held = Command.of(state.command)
    state.copy(
      flownS = state.flownS + span.toSeconds,
      flights = (held +: held.moved)
        .lazyZip(state.flights)
        .map((command, flying) => flown(flying, command.turned(rate * state.flownS), rate, span)),
      samples = state.samples.map(advanced(_, span)),
      plain = ConstantTurn.advanced(state.plain, setpoint, span)
    )

  /** The sample after this time, within which its rate may change once. */
  private def advanced(sample: Sample[S], span: Span): Sample[S] =
    val s     = span.toSeconds
    val first = turned(sample, sample.rateRadps, s.min(sample.leftS))
    if sample.leftS >= s then first.copy(leftS = sample.leftS - s)
    else
      turned(first, sample.nextRadps, s - sample.leftS)
        .copy(rateRadps = sample.nextRadps, leftS = Double.PositiveInfinity)

  private def turned(sample: Sample[S], rate: Double, s: Double): Sample[S] =
    if s <= 0 then sample
    else
      sample.copy(
        flying = flown(sample.flying, sample.command, rate, Span.ofSeconds(s)),
        command = sample.command.turned(rate * s)
      )

  /** Simulates a flight under a turning command, in pieces with a constant command. */
  private def flown(from: S, command: Command, rate: Double, span: Span): S =
    val pieces = (span.toSeconds / PieceS).ceil.max(1).toInt
    val piece  = span / pieces.toLong
    (0 until pieces).foldLeft(from): (flying, number) =>
      val at    = command.turned(rate * piece.toSeconds * (number + 0.5))
      val lasts = if number == pieces - 1 then span - piece * number.toLong else piece
      model.advanced(flying, Setpoint.velocity(at.north, at.east, at.down), lasts)

  def corrected(state: Believed[S], seen: Kinematics, sinceSeen: Span): Believed[S] =
    val learned =
      if sinceSeen <= Span.Zero then state
      else if sinceSeen <= AdaptiveQuadrotor.LongestGap then learnt(state, seen, sinceSeen.toSeconds)
      else state.copy(command = commandOf(seen), turns = state.turns.after(sinceSeen.toSeconds))
    sampled(learned.copy(
      flownS = 0,
      flights = same(model.corrected(state.flights.head, seen, sinceSeen)),
      plain = ConstantTurn.corrected(state.plain, seen, sinceSeen)
    ))

  private def learnt(state: Believed[S], seen: Kinematics, s: Double): Believed[S] =
    val angle      = state.turns.mean * s
    val before     = Command.of(state.command)
    val measured   = ParameterBelief.outputs(seen)
    val predicted  = state.flights.map(flying => ParameterBelief.outputs(model.kinematics(flying)))
    val turned     = before.turned(angle)
    val drifted    = state.command.drifted(DriftsMps, s, MostOffMps)
    val expected   = drifted.copy(mean = Vector(turned.north, turned.east, turned.down))
    val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
    val explains   = expected.updatedAll(measured, predicted.head, Noises): i =>
      // The moved commands have turned since.
      val moved = Vector(1, 2, 3).map(j => (predicted(j)(i) - predicted.head(i)) / MovedMps)
      Vector(moved(0) * cos - moved(1) * sin, moved(0) * sin + moved(1) * cos, moved(2))
    // With a larger difference the vehicle tilts as much as it can, and readings do not show the command.
    val command = explains.copy(mean = Vector.tabulate(3): i =>
      explains.mean(i).max(measured(i) - MostOffMps(i)).min(measured(i) + MostOffMps(i)))
    val after                 = Command.of(command)
    val keeps                 = StrictMath.exp(-s / MemoryS)
    def off(from: Kinematics) =
      val by = seen.velocityNed - from.velocityNed
      by.x * by.x + by.y * by.y
    state.copy(
      command = command,
      error = state.error * keeps + off(mean(state)),
      plainError = state.plainError * keeps + off(state.plain.now),
      turns =
        if before.speed.min(after.speed) < StillMps then TurnRates.of(after.heading)
        else state.turns.after(s, after.heading)
    )

  /** Draws new samples, evenly spread by additive recurrences: equal readings give equal samples. */
  private def sampled(state: Believed[S]): Believed[S] =
    val command = Command.of(state.command)
    val offMps  = StrictMath.hypot(OffMps, command.speed * StrictMath.sqrt(state.turns.offRad2))
    val next    = state.turns.next
    state.copy(samples = Vector.tabulate(Samples): number =>
      def evenly(step: Double) =
        val sum = 0.5 + step * number
        sum - math.floor(sum)
      val rate    = drawn(state.turns.shares, (number + 0.5) / Samples)
      val heading = state.turns.headings(rate)
      Sample(
        state.flights.head,
        Command(
          command.speed * StrictMath.cos(heading) + offMps * (2 * evenly(0.4301597090019468) - 1),
          command.speed * StrictMath.sin(heading) + offMps * (2 * evenly(0.3247179572447460) - 1),
          command.down
        ),
        TurnRates.Each(rate),
        -TurnRates.HoldsS * StrictMath.log(1 - evenly(0.7548776662466927)),
        TurnRates.Each(drawn(next, evenly(0.5698402909980532)))
      ))

  def kinematics(state: Believed[S]): Kinematics = if state.helps then mean(state) else state.plain.now

  /** The mean of the samples' positions and velocities; the orientation is that under the mean turn rate. */
  private def mean(state: Believed[S]): Kinematics =
    val all                             = state.samples.map(sample => model.kinematics(sample.flying))
    def mean(of: Kinematics => Vector3) = all.map(of).reduce(_ + _) * (1.0 / all.size)
    model
      .kinematics(state.flights.head)
      .copy(positionNed = mean(_.positionNed), velocityNed = mean(_.velocityNed))

object TurnBelief:
  val Samples = 32

  /** Time constant of the errors that the guard compares, s. */
  val MemoryS = 5.0

  /** Longest time for which a turning command is simulated as constant, s. */
  private val PieceS = 0.05

  /** The change of a command by which its effect is found, and the speed below which a heading is
    * meaningless, m/s.
    */
  private val MovedMps = 0.5
  private val StillMps = 0.5

  /** Maximum difference between command and velocity, which is also its standard deviation before any
    * reading; and standard deviations of the command's change within a second, in addition to its turn:
    * north, east, down, m/s.
    */
  private val MostOffMps = Vector(4.5, 4.5, 2)
  private val DriftsMps  = Vector(3.0, 3, 1)

  /** Standard deviations of the errors that even a correct model has between two readings: of velocities,
    * m/s, and of the sines of tilts.
    */
  private val Noises = Vector(0.01, 0.01, 0.01, 0.006, 0.006)

  /** Maximum deviation of the samples' commands from the estimate along an axis, m/s. With this value and
    * [[TurnRates.HoldsS]], discs around nine of ten samples contained nine of ten positions in flights.
    */
  private val OffMps = 1.0

  /** A commanded velocity, in the world frame, m/s. */
  final case class Command(north: Double, east: Double, down: Double):
    def speed: Double   = StrictMath.hypot(north, east)
    def heading: Double = StrictMath.atan2(east, north)

    def turned(angle: Double): Command =
      val (cos, sin) = (StrictMath.cos(angle), StrictMath.sin(angle))
      copy(north * cos - east * sin, north * sin + east * cos)

    private[TurnBelief] def moved: Vector[Command] =
      Vector(copy(north = north + MovedMps), copy(east = east + MovedMps), copy(down = down + MovedMps))

  object Command:
    private[TurnBelief] def of(belief: ParameterBelief): Command =
      Command(belief.mean(0), belief.mean(1), belief.mean(2))

  /** One possible flight of the vehicle, with one change of the turn rate.
    *
    * @param leftS time until the rate changes to `nextRadps`
    */
  final case class Sample[S](flying: S, command: Command, rateRadps: Double, leftS: Double, nextRadps: Double)

  /** The estimate of a vehicle's command, and the predictions.
    *
    * @param command mean and covariance of its commanded velocity at the last reading, m/s
    * @param flownS time since the last reading, s
    * @param flights the model's states since then under that command, and under commands moved to north, east
    *   and down
    * @param error sum of the squared errors of the mean velocity, fading, m²/s²; `plainError` likewise that
    *   of `plain`
    */
  final case class Believed[S](
      command: ParameterBelief,
      turns: TurnRates,
      flownS: Double,
      flights: Vector[S],
      samples: Vector[Sample[S]],
      plain: ConstantTurn.Turning,
      error: Double,
      plainError: Double
  ):
    /** Whether the samples predict; otherwise [[ConstantTurn]] does. */
    def helps: Boolean = error < plainError

  private def same[S](flying: S) = Vector.fill(4)(flying)

  /** The index of the share at which the running sum reaches `at`, from 0 to 1. */
  private def drawn(shares: Vector[Double], at: Double): Int =
    val index = shares.scanLeft(0.0)(_ + _).tail.indexWhere(_ >= at)
    if index < 0 then shares.size - 1 else index
