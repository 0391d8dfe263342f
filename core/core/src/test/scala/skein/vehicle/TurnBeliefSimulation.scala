package skein.vehicle

import skein.signal.{Kinematics, SplitMix64}
import skein.units.*

/** Estimates of vehicles whose commands are unknown. */
class TurnBeliefSimulation extends munit.FunSuite:
  private val quadrotor = QuadrotorModel.AirSim
  private val belief    = TurnBelief(quadrotor)
  private val tenth     = Span.ofMillis(100)
  private val unused    = Setpoint.velocity(0, 0, 0)

  /** A vehicle's states, one each 0.1 s, commanded a velocity of 6 m/s on a heading of each. */
  private def flown(headings: Seq[Double]): Vector[Kinematics] =
    headings
      .scanLeft(quadrotor.start(Kinematics(
        Vector3(0, 0, -20),
        Vector3(0, 0, 0),
        Quaternion.Identity,
        Vector3(0, 0, 0)
      ))): (flying, heading) =>
        val climbs = 20 + quadrotor.kinematics(flying).positionNed.z
        quadrotor.advanced(
          flying,
          Setpoint.velocity(6 * StrictMath.cos(heading), 6 * StrictMath.sin(heading), -climbs),
          tenth
        )
      .map(quadrotor.kinematics)
      .toVector

  /** Headings that turn left and right at 0.8 rad/s in turn, for 1 to 4 s each. */
  private def weaving(seed: Long, count: Int): Vector[Double] =
    val random = SplitMix64(seed)
    Iterator
      .iterate((heading = 0.0, rate = 0.8, left = 20)): now =>
        val rate = if now.left == 0 then -now.rate else now.rate
        val left = if now.left == 0 then 10 + (30 * random.nextDouble()).toInt else now.left - 1
        (heading = now.heading + rate * 0.1, rate = rate, left = left)
      .map(_.heading)
      .take(count)
      .toVector

  /** The model's state after each reading. */
  private def seen[S](model: VehicleModel[S], readings: Vector[Kinematics]): Vector[S] =
    readings.tail.scanLeft(model.start(readings.head)): (state, reading) =>
      model.corrected(model.advanced(state, unused, tenth), reading, tenth)

  private def errors[S](model: VehicleModel[S], readings: Vector[Kinematics], steps: Int): Vector[Double] =
    seen(model, readings).drop(50).zip(readings.drop(50 + steps)).map: (state, later) =>
      val ahead = model.kinematics(model.advanced(state, unused, tenth * steps.toLong))
      ahead.positionNed.horizontalDistance(later.positionNed)

  /** Whether a place is in the disc around the samples' mean place that holds a share of the samples. */
  private def isWithin(state: TurnBelief.Believed[QuadrotorModel.Flying], at: Vector3, share: Double) =
    val places = state.samples.map(sample => quadrotor.kinematics(sample.flying).positionNed)
    val mean   = places.reduce(_ + _) * (1.0 / places.size)
    at.horizontalDistance(
      mean
    ) <= places.map(_.horizontalDistance(mean)).sorted.apply((share * places.size).toInt)

  private def rms(of: Vector[Double]) = math.sqrt(of.map(x => x * x).sum / of.size)

  test(
    "after four steps of a turn its direction is known, and turn rates seen before are the most expected next"
  ):
    val headings = weaving(1, 400)
    val states   = seen(belief, flown(headings))
    // The heading of the step before a reading, and four before that.
    val known = (100 until headings.size).flatMap: step =>
      val turns = (step - 4 until step).map(before => (headings(before + 1) - headings(before)).sign)
      Option.when(turns.distinct.sizeIs == 1)(states(step + 1).turns.mean.sign == turns.head)
    assert(known.count(identity) > 0.95 * known.size, s"${known.count(identity)} of ${known.size}")
    val next = TurnRates.Each.zip(states.last.turns.next).sortBy(-_._2).take(4).map(_._1.abs)
    assert(next.forall(rate => rate > 0.5 && rate < 1.1), next.toString)

  test(
    "discs of nine tenths of the samples cover about nine of ten positions; the mean beats a constant turn"
  ):
    val readings = flown(weaving(2, 400))
    for steps <- Seq(4, 8) do
      val ahead = seen(belief, readings).drop(50).zip(readings.drop(50 + steps)).map: (state, later) =>
        (belief.advanced(state, unused, tenth * steps.toLong), later.positionNed)
      val within = ahead.count((state, at) => isWithin(state, at, share = 0.9))
      val share  = within.toDouble / ahead.size
      assert(share > 0.85 && share < 0.97, s"$share within after ${steps * 100} ms")
      val ours    = rms(ahead.map((state, at) => belief.kinematics(state).positionNed.horizontalDistance(at)))
      val turning = rms(errors(ConstantTurn, readings, steps))
      assert(ours < 0.9 * turning, s"$ours and $turning after ${steps * 100} ms")

  test("a vehicle with other commands than assumed is predicted no worse than by its last turn"):
    val random          = SplitMix64(5)
    val jumping         = Vector.fill(40)(2 * math.Pi * random.nextDouble()).flatMap(Vector.fill(8)(_))
    val readings        = flown(jumping)
    val (ours, turning) = (errors(belief, readings, 4), errors(ConstantTurn, readings, 4))
    assert(rms(ours) < 1.05 * rms(turning), s"${rms(ours)} and ${rms(turning)}")
