package skein.flight

import skein.loop.{Knowledge, LoopKind, Strangers}
import skein.measure.FlightSummary
import skein.optimise.RunningStats
import skein.record.Recording
import skein.scenario.{Scenarios, Shadow}
import skein.settings.FlySettings
import skein.signal.{LatencyDistribution, LatencyProfile}
import skein.units.*
import skein.units.Decimals.{fixed, signed}
import skein.vehicle.*

/** The link `vpn` with its round trips multiplied by a factor. */
private def vpnTimes(times: Int): LatencyProfile =
  val trips = Vector.tabulate(200)(i => times * LatencyDistribution.Vpn.quantile((i + 0.5) / 200).toMillis)
  LatencyProfile.Steady(s"vpn-$times", LatencyDistribution.ofSamples(trips))

/** Prints how well a hidden leader is predicted. */
@main def beliefErrors(course: Int, times: Int, plans: Boolean): Unit =
  val profile  = vpnTimes(times)
  val settings = FlySettings(
    List(LoopKind.Predictive),
    List(profile),
    Span.ofSeconds(60),
    Span.ofMillis(100),
    1,
    Shadow(course = course),
    planInPacket = plans,
    knows = Knowledge.Positions
  )
  val recording = VirtualFlights.fly(settings, settings.plans.head).fold(sys.error(_), _.recorder.recording)
  val readings  = recording.readings.filter(_.vehicle == "Leader").map(_.state).sortBy(_.validAt)
  def placeAt(at: Instant): Option[Vector3] =
    readings.zip(readings.drop(1)).find((a, b) => a.validAt <= at && at <= b.validAt).map: (a, b) =>
      val s = b.validAt.since(a.validAt).toSeconds
      val u = at.since(a.validAt).toSeconds / s
      a.value.positionNed * ((1 + 2 * u) * (1 - u) * (1 - u)) + a.value.velocityNed * (u * (1 - u) * (1 - u) * s) +
        b.value.positionNed * (u * u * (3 - 2 * u)) + b.value.velocityNed * (u * u * (u - 1) * s)
  def predictions[S](model: VehicleModel[S], s: Double): Vector[(S, Vector3)] =
    val start = model.start(readings.head.value)
    val step  = Setpoint.velocity(0, 0, 0)
    readings.sliding(2).toVector.map(two => (two(0), two(1))).scanLeft((start, readings.head)):
      (state, two) =>
        val since = two._2.validAt.since(two._1.validAt)
        (model.corrected(model.advanced(state._1, step, since), two._2.value, since), two._2)
    .filter(_._2.validAt.since(readings.head.validAt) > Span.ofSeconds(5))
      .flatMap: (state, reading) =>
        placeAt(reading.validAt + Span.ofSeconds(s)).map((model.advanced(state, step, Span.ofSeconds(s)), _))
  def errors[S](model: VehicleModel[S], s: Double) =
    predictions(model, s).map((state, there) => (model.kinematics(state).positionNed - there).norm)
  def rms(all: Vector[Double]) = math.sqrt(all.map(x => x * x).sum / all.size)
  def p95(all: Vector[Double]) = all.sorted.apply(all.size * 95 / 100)
  val belief                   = TurnBelief(QuadrotorModel.AirSim)
  // Whether a place is in the disc around the samples' mean place that holds a share of the samples.
  def isWithin(state: TurnBelief.Believed[QuadrotorModel.Flying], at: Vector3, share: Double) =
    val places = state.samples.map(sample => QuadrotorModel.AirSim.kinematics(sample.flying).positionNed)
    val mean   = places.reduce(_ + _) * (1.0 / places.size)
    at.horizontalDistance(
      mean
    ) <= places.map(_.horizontalDistance(mean)).sorted.apply((share * places.size).toInt)
  for s <- Seq(0.1, 0.2, 0.4, 0.8, 1.2) do
    def line(name: String, off: Vector[Double]) =
      println(
        f"$s%.1f s  $name%-9s rms ${rms(off)}%.3f  median ${off.sorted.apply(off.size / 2)}%.3f p95 ${p95(off)}%.3f"
      )
    line("straight", errors(ConstantVelocity, s))
    line("turn", errors(ConstantTurn, s))
    line("belief", errors(belief, s))
    val all = predictions(belief, s)
    val in  = all.count((state, there) => isWithin(state, there, share = 0.9))
    val by  = all.count((state, _) => state.helps)
    println(
      f"$s%.1f s  within nine of ten: ${100.0 * in / all.size}%.1f %%, by samples: ${100.0 * by / all.size}%.0f %%"
    )

/** Compares ways to predict a hidden leader: prints a follower's deviation from its paused flight.
  *
  * {{{
  * ./sbtw "flight/Test/runMain skein.flight.beliefFigures 3 2 4"
  * }}}
  *
  * @param times factors of the round trips of `vpn`
  */
@main def beliefFigures(seeds: Int, times: Int*): Unit =
  given Scenarios = Scenarios.ours
  def settings(loop: LoopKind, link: LatencyProfile, strangers: Strangers, plans: Boolean, course: Int) =
    FlySettings(
      List(loop),
      List(link),
      duration = Span.ofSeconds(60),
      period = Span.ofMillis(100),
      seed = 1,
      scenario = Shadow(course = course),
      planInPacket = plans,
      knows = Knowledge.Positions,
      strangers = strangers
    )
  def flown(of: Int => FlySettings) =
    VirtualFlights
      .eachInParallel(Vector.tabulate(seeds)(number => of(number + 1).plans.head.copy(seed = 1L + number))):
        plan =>
          VirtualFlights.fly(of(plan.seed.toInt), plan).map(_.recorder.recording)
      .map(_.fold(missing => sys.error(missing.message), identity))
  def headline(recording: Recording) = FlightSummary.of(recording).headline.get
  val truths = flown(settings(LoopKind.Paused, LatencyProfile.none, Strangers.Turn, false, _)).map(headline)
  println(s"truths ${truths.map(_.fixed(3)).mkString(", ")} m")
  for
    times     <- times
    plans     <- Seq(false, true)
    strangers <- Strangers.values
  do
    val link  = vpnTimes(times)
    val all   = flown(settings(LoopKind.Predictive, link, strangers, plans, _))
    val off   = all.map(headline).zip(truths).map((of, truth) => 100 * (of / truth - 1))
    val stats = RunningStats.of(off.size)(off)
    println(
      f"vpn x $times, plans $plans, ${strangers.label}%-8s: ${stats.mean.signed(1)} ± ${stats.halfWidth95.fixed(1)} %% " +
        off.map(_.signed(1)).mkString(", ")
    )
