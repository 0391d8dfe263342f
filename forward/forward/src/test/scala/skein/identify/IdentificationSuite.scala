package skein.identify

import skein.forecast.Structure
import skein.policy.Action
import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.*
import skein.vehicle.{PlantFlight, ReducedModel}

class IdentificationSuite extends munit.FunSuite:
  private val truth =
    ReducedModel(gain = 0.95, lagS = 1.7, deadTimeS = 0.12, turnLagS = 2.4, dragPerM = 0.008)

  /** A flight of the model under commands that turn and change speed, sampled ten times per second with
    * noise.
    */
  private def flown(
      model: ReducedModel,
      seed: Long,
      noiseMps: Double,
      jitterS: Double = 0,
      spanS: Double = 60
  ): TimeHistory =
    val source   = SplitMix64(seed)
    def normal() = NormalQuantile(source.nextDouble().max(1e-12).min(1 - 1e-12))
    val arrivals = Vector.tabulate((spanS / 0.3).toInt): k =>
      val heading = 4 * source.nextDouble()
      val speed   = 3 + 8 * source.nextDouble()
      ArrivedCommand(0.05 + 0.3 * k, Action.Along(Radians(heading), MetresPerSecond(speed), Metres(-20)))
    val flight = PlantFlight(model)
    flight.start(0, model.initial)
    var next    = 0
    val samples = Vector.tabulate((spanS / 0.1).toInt): k =>
      val atS = 0.1 * k
      while next < arrivals.size && arrivals(next).atS + model.deadTimeS <= atS do
        flight.act(arrivals(next).atS + model.deadTimeS, arrivals(next).vx, arrivals(next).vy)
        next += 1
      flight.advance(atS)
      Sample(
        atS,
        flight.reading.northM + noiseMps / 10 * normal(),
        flight.reading.eastM + noiseMps / 10 * normal(),
        flight.reading.northMps + noiseMps * normal(),
        flight.reading.eastMps + noiseMps * normal()
      )
    // The arrival times given to the identification deviate by the links' jitter.
    val told = arrivals.map(arrival => arrival.copy(atS = arrival.atS + jitterS * normal()))
    TimeHistory(s"synthetic $seed", samples, told.sortBy(_.atS), -20)

  private def identified(flights: Vector[TimeHistory], structure: Structure): Identification =
    Identification.of(flights, structure).fold(fail(_), identity)

  private def valuesOf(model: ReducedModel): Map[String, Double] = Map(
    "gain"        -> model.gain,
    "lag-s"       -> model.lagS,
    "dead-time-s" -> model.deadTimeS,
    "turn-lag-s"  -> model.turnLagS,
    "drag-per-m"  -> model.dragPerM
  )

  test("every structure finds its parameters again from a flight without noise"):
    for
      structure <- Structure.ours
      expected = structure match
        case Structure.Lag         => truth.copy(turnLagS = truth.lagS, dragPerM = 0)
        case Structure.Turn        => truth.copy(dragPerM = 0)
        case Structure.Drag        => truth.copy(turnLagS = truth.lagS)
        case Structure.DragAndTurn => truth
      found = identified(Vector(flown(expected, seed = 1, noiseMps = 0)), structure)
      parameter <- found.parameters
    do
      val value = valuesOf(expected)(parameter.name)
      assertEqualsDouble(parameter.value, value, 1e-4 * (1 + value), s"$structure ${parameter.name}")

  test("the 95 % intervals cover the true values in most repetitions with noise and jitter"):
    val runs      = 30
    val structure = Structure.DragAndTurn
    val covered   = (1 to runs).flatMap: seed =>
      identified(Vector(flown(truth, seed, noiseMps = 0.05, jitterS = 0.01)), structure).parameters.map:
        fitted =>
          val value = valuesOf(truth)(fitted.name)
          (fitted.name, fitted.least <= value && value <= fitted.most)
    for (name, hits) <- covered.groupMap(_._1)(_._2) do
      // 24 of 30 or fewer happens with less than 1 in 100 if the coverage is 93 %.
      assert(hits.count(identity) >= 24, s"$name: ${hits.count(identity)} of $runs (seeds 1 to $runs)")

  test("intervals narrow as flights are added"):
    val one  = identified(Vector(flown(truth, 1, 0.1)), Structure.Lag)
    val four = identified(Vector.tabulate(4)(i => flown(truth, i + 1, 0.1)), Structure.Lag)
    for (wide, narrow) <- one.parameters.zip(four.parameters) do
      assert(narrow.most - narrow.least < 0.8 * (wide.most - wide.least), s"$wide $narrow")

  test("a parameter at its bound is reported as such"):
    val found = identified(Vector(flown(ReducedModel(0.9, 1, 0, 1, 0), 1, 0)), Structure.Drag)
    val drag  = found.parameters.find(_.name == "drag-per-m")
    assert(drag.exists(fitted => fitted.value < 1e-4 && fitted.atBound), found)

  test("flights that are too short, or that have constant commands, are refused with what was expected"):
    val short = Identification.of(Vector(flown(truth, 1, 0, spanS = 10)), Structure.Lag)
    assert(short.left.exists(_.contains("expected at least")), short)
    // What remains before the last horizon counts.
    val distant = Identification.of(Vector(flown(truth, 1, 0)), Structure.Lag, horizonS = 70)
    assert(distant.left.exists(_.endsWith("got 0 s")), distant)
    val steady = flown(truth, 1, 0)
    val same   = Identification.of(Vector(steady.copy(arrivals = steady.arrivals.take(1))), Structure.Lag)
    assert(same.left.exists(_.contains("changing commands")), same)
