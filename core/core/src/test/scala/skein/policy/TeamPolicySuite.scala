package skein.policy

import skein.scenario.*
import skein.units.*

class TeamPolicySuite extends munit.FunSuite:

  test("pursuers rest on the ring, at even bearings, around an evader that does not move"):
    val surround = Surround(vehicles = 6)
    val agents   = surround.agents
    val still    = agents.head.copy(policy = Flee(0))
    val flight   = TeamFlight(Fleet(still +: agents.tail), lagS = 1.5)
    flight.fly(60)()
    val bearings = (1 to 5)
      .map(pursuer =>
        math.atan2(flight.eastM(pursuer) - flight.eastM(0), flight.northM(pursuer) - flight.northM(0))
      )
      .sorted
    for pursuer <- 1 to 5 do
      assertEqualsDouble(flight.distanceM(0, pursuer), surround.ringM, 0.01)
      assertEqualsDouble(math.hypot(flight.northMps(pursuer), flight.eastMps(pursuer)), 0, 0.01)
    for (before, after) <- bearings.zip(bearings.tail) do
      assertEqualsDouble(after - before, 2 * math.Pi / 5, 0.01)

  test("every pursuer has its own slot, at whatever bearing the order begins"):
    val random = scala.util.Random(5)
    for turn <- 0 until 200 do
      val bearings                 = Seq.fill(7)((random.nextDouble() - 0.5) * 2 * math.Pi)
      val policy                   = Surrounding(evader = 3, ringM = 5, mostMps = 8)
      def slots(turnedRad: Double) =
        val around = bearings.map(_ + turnedRad)
        val all    = around.take(3) ++ Seq(Double.NaN) ++ around.drop(3)
        val flat   = Seq.fill(8)(0.0)
        for self <- 0 until 8 if self != 3
        yield policy.slotRad(
          TeamFlight.seen(
            self,
            all.map(rad => if rad.isNaN then 0.0 else 9 * math.cos(rad)),
            all.map(rad => if rad.isNaN then 0.0 else 9 * math.sin(rad)),
            flat,
            flat,
            0,
            0
          )
        ) - turnedRad
      val plain = slots(0)
      for (one, other) <- plain.zip(slots(random.nextDouble() * 7)) do
        assertEqualsDouble(math.cos(one), math.cos(other), 1e-9, s"turn $turn")
        assertEqualsDouble(math.sin(one), math.sin(other), 1e-9, s"turn $turn")
      assertEquals(
        plain.map(rad => math.floorMod(math.round((rad - plain.head) / (2 * math.Pi / 7)), 7L)).toSet.size,
        7
      )

  test("the evader flees straight away from the nearest pursuer"):
    val still = Seq.fill(3)(0.0)
    val seen  = TeamFlight.seen(0, Seq(0, 3, -2), Seq(0, 4, -1), still, still, 0, 0.1)
    Flee(4).choose(seen, ())._1 match
      case Action.Along(heading, speed, down, Yaw.Still) =>
        assertEqualsDouble(heading.value, math.atan2(1, 2), 1e-12)
        assertEquals((speed, down), (MetresPerSecond(4), seen.startDown))
      case other => fail(s"got $other")

  test(
    "a distance along the circuit is recovered from its point, and directions are those from point to point"
  ):
    val circuit = Racetrack(50, 20)
    for step <- 0 until 500 do
      val place         = circuit.lengthM * step / 500
      val (north, east) = circuit.point(place)
      assertEqualsDouble(circuit.nearest(north, east), place, 1e-9)
      val (nextNorth, nextEast) = circuit.point(place + 1e-6)
      assertEqualsDouble((nextNorth - north) / 1e-6, math.cos(circuit.headingRad(place)), 1e-5)
      assertEqualsDouble((nextEast - east) / 1e-6, math.sin(circuit.headingRad(place)), 1e-5)

  private def slotErrorsM(formation: Formation, flight: TeamFlight): Seq[Double] =
    val circuit    = formation.circuit
    val heading    = circuit.headingRad(circuit.nearest(flight.northM(0), flight.eastM(0)))
    val (cos, sin) = (math.cos(heading), math.sin(heading))
    for ((ahead, right), index) <- formation.slots.zipWithIndex
    yield math.hypot(
      flight.northM(0) + ahead * cos - right * sin - flight.northM(index + 1),
      flight.eastM(0) + ahead * sin + right * cos - flight.eastM(index + 1)
    )

  test("a formation has no error on the straight"):
    val formation = Formation(straightM = 500, lagS = 0.8)
    val flight    = TeamFlight(formation.fleet, lagS = 0.8)
    flight.fly(60)()
    assert(slotErrorsM(formation, flight).max < 0.01, slotErrorsM(formation, flight))

  test("the slots of a formation turn with the leader"):
    val formation = Formation(straightM = 0, radiusM = 30, lagS = 0)
    val flight    = TeamFlight(formation.fleet, lagS = 0, stepS = 0.01)
    var worst     = 0.0
    flight.fly(10)()
    flight.fly(40)({ worst = worst.max(slotErrorsM(formation, flight).max) })
    // Without turn rate × offset in the slot's velocity it would be 0.6 m.
    assert(worst < 0.15, s"$worst m")

  test("a formation of lagging vehicles turns with its leader if its policies know the lag"):
    def worstM(lagS: Double) =
      val formation = Formation(straightM = 0, radiusM = 30, lagS = lagS)
      val scenario  = formation.fleet
      // The leader flies the same way in both.
      val leader = Formation(straightM = 0, radiusM = 30, lagS = 1.5).agents.head
      val flight = TeamFlight(Fleet(leader +: scenario.agents.tail), lagS = 1.5, stepS = 0.01)
      var worst  = 0.0
      flight.fly(30)()
      flight.fly(20)({ worst = worst.max(slotErrorsM(formation, flight).max) })
      worst
    assert(worstM(1.5) < 0.2, s"${worstM(1.5)} m")
    assert(worstM(0) > 0.5, s"${worstM(0)} m")

  private def headOn(sideM: Double, lagS: Double): TeamFlight =
    def one(name: String, north: Double, east: Double, heading: Double) = Agent(
      name,
      Role.Traveller,
      MetresPerSecond(5),
      Vector3(north, east, -5),
      Radians(heading),
      Avoidance(-north, -east, cruiseMps = 5, mostMps = 8, minimumM = 2, marginM = 1.5, horizonS = 4)
    )
    val flight = TeamFlight(Fleet(Vector(one("A", -30, -sideM, 0), one("B", 30, sideM, math.Pi))), lagS)
    flight.fly(30)()
    flight

  for (sideM, lagS) <- Seq((0.0, 0.0), (0.5, 0.0), (-0.5, 0.0)) do
    test(
      s"two vehicles head-on, $sideM m to the side, pass with the required separation and reach their goals"
    ):
      val flight = headOn(sideM, lagS)
      assert(flight.leastM > 3.45, s"${flight.leastM} m")
      assertEqualsDouble(flight.northM(0), 30, 0.1)
      assertEqualsDouble(flight.northM(1), -30, 0.1)

  test(
    "two vehicles that lag 1.5 s behind their commands pass with the minimum separation, due to the margin"
  ):
    val flight = headOn(0, lagS = 1.5)
    assert(flight.leastM > 2.0, s"${flight.leastM} m")

  test(
    "twenty vehicles in four streams cross with the required separation if they follow commands immediately"
  ):
    val crossing = Crossing()
    val flight   = TeamFlight(crossing.fleet, lagS = 0)
    flight.fly(60)()
    assert(flight.leastM > crossing.minimumM, s"${flight.leastM} m")
    val missing = crossing.goals.zipWithIndex.map: (goal, vehicle) =>
      math.hypot(goal._1 - flight.northM(vehicle), goal._2 - flight.eastM(vehicle))
    assert(missing.max < 1, missing)

  test(
    "the chosen velocity is the allowed one nearest to the wanted velocity, as found by a search over a grid"
  ):
    import Avoidance.*
    val random                = scala.util.Random(3)
    var allowed, least, edged = 0
    for turn <- 0 until 150 do
      def normal = { val rad = random.nextDouble() * 2 * math.Pi; Velocity(math.cos(rad), math.sin(rad)) }
      val bounds = Array.fill(5)(Bound(Velocity(random.nextGaussian(), random.nextGaussian()), normal))
      // Some lie side by side: no corner of theirs is anywhere near.
      if turn % 4 == 0 then bounds(1) = bounds(1).copy(normal = bounds(0).normal * -1)
      val wanted = Velocity(random.nextGaussian() * 4, random.nextGaussian() * 4)
      val planes = HalfPlanes(bounds.length)
      for (bound, i) <- bounds.zipWithIndex do
        planes.put(i, bound.normal.north, bound.normal.east, bound.at dot bound.normal)
      def worst(of: Velocity) = bounds.indices.map(planes.broken(_, of)).max
      val grid                =
        for
          north <- -60 to 60
          east  <- -60 to 60
          one = Velocity(north / 10.0, east / 10.0)
          if (one dot one) <= 36
        yield one
      val within  = grid.filter(worst(_) <= 0).map(one => math.sqrt((one - wanted) dot (one - wanted)))
      val nearest = planes.nearest(wanted, 6)
      if nearest.missing <= 0 then
        val found = nearest.velocity
        val away  = math.sqrt((found - wanted) dot (found - wanted))
        assert(worst(found) <= 1.01e-4 && (found dot found) <= 36.0001, s"turn $turn")
        assert(within.forall(_ >= away - 1e-6), s"turn $turn: the grid has ${within.min}, got $away")
        allowed += 1
      else
        assert(within.isEmpty, s"turn $turn")
        val found = planes.leastBroken(wanted, 6)
        val best  = grid.map(worst).min
        assert(worst(found) <= best + 1e-3, s"turn $turn: ${worst(found)}, the grid has $best")
        if turn % 4 == 0 then edged += 1
        least += 1
    assert(
      allowed > 20 && least > 20 && edged > 10,
      s"$allowed allowed, $least least broken, $edged side by side"
    )

  test("the chosen velocity keeps clear of more than twenty neighbours, as far as that is possible"):
    val random                = scala.util.Random(4)
    var allowed, least, short = 0
    for turn <- 0 until 4000 do
      val planes = HalfPlanes(31)
      for i <- 0 until 31 do
        val rad = random.nextDouble() * 2 * math.Pi
        planes.put(
          i,
          math.cos(rad),
          math.sin(rad),
          random.nextGaussian() * 2 - (if turn % 2 == 0 then 5 else 1)
        )
      val wanted  = Velocity(random.nextGaussian() * 5, random.nextGaussian() * 5)
      val nearest = planes.nearest(wanted, 10)
      val found   = if nearest.missing > 0 then planes.leastBroken(wanted, 10) else nearest.velocity
      val worst   = (0 until 31).map(planes.broken(_, found)).max
      if nearest.missing <= 0 then
        allowed += 1
        assert(worst <= 1.01e-4, s"turn $turn: $worst")
      else
        least += 1
        // Nothing near is better.
        val better = (0 until 64).exists: way =>
          val rad   = way * math.Pi / 32
          val aside = found + Velocity(math.cos(rad), math.sin(rad)) * 0.02
          (aside dot aside) <= 100 && (0 until 31).map(planes.broken(_, aside)).max < worst - 1e-3
        if better then short += 1
    assert(allowed > 500 && least > 500, s"$allowed allowed, $least least broken")
    assert(short <= 4, s"$short of $least fell short")

  test("neighbours out of reach or at one position give finite numbers"):
    for side <- Seq(0.0, 1e6) do
      val policy = Avoidance(10, 0, cruiseMps = 5, mostMps = 8, minimumM = 2, marginM = 1.5, horizonS = 4)
      val places = Seq(side, 0, 0)
      val still  = Seq.fill(3)(0.0)
      val action = policy.choose(TeamFlight.seen(1, places, places, still, still, 0, 0.1), ())._1
      assert(action.headingRad(Double.NaN).isFinite && action.speed.value <= 8.001, s"$action")
