package skein.scenario

import skein.policy.*
import skein.units.*
import skein.units.Decimals.significant
import skein.vehicle.{ReducedModel, VehicleKind}

/** Two cars drive round a circuit, one behind the other, and three drones escort them: one ahead of the cars
  * to their right, one to their left, one behind them. The drones' slots rotate with the road at the leading
  * car.
  *
  * @param gapM distance between the two cars, along the circuit
  * @param carMps speed of the leading car
  * @param mostMps maximum commanded speed
  * @param straightM length of each of the circuit's two straights
  * @param radiusM radius of the circuit's half turns
  * @param altitudeM altitude of the drones
  * @param sightM horizontal distance within which a drone observes a car
  */
final case class Convoy(
    gapM: Double = 12,
    carMps: Double = 7,
    mostMps: Double = 12,
    straightM: Double = 60,
    radiusM: Double = 25,
    altitudeM: Double = 10,
    sightM: Double = 15
) extends Scenario:
  import Convoy.*

  override def mistakes: Seq[String] = Scenario.notPositive(this, "straightM")

  def circuit: Racetrack = Racetrack(straightM, radiusM)

  /** The drones' slots: distance ahead of the leading car, and to its right, m. */
  def places: Vector[(Double, Double)] = Vector((6.0, 7.0), (-gapM / 2, -9.0), (-gapM - 8, 0.0))

  def agents: Vector[Agent] =
    val lagS   = ReducedModel.airSimAt(altitudeM).lagS
    val drones = places.zipWithIndex.map:
      case ((aheadM, rightM), drone) =>
        Agent(
          s"Escort${drone + 1}",
          Role("Escort"),
          MetresPerSecond(carMps),
          Vector3(aheadM, rightM, -altitudeM),
          Radians(0),
          KeepSlot(0, circuit, aheadM, rightM, mostMps, lagS)
        )
    val leads   = LeadOnCircuit(circuit, carMps, carMps * AheadS)
    val follows = FollowOnCircuit(0, circuit, gapM, mostMps, carMps * AheadS)
    (car("Lead", 0, leads) +: drones) :+ car("Rear", -gapM, follows)

  private def car(name: String, northM: Double, policy: Policy) =
    val start = Vector3(northM, 0, 0)
    Agent(name, Role("Car"), MetresPerSecond(carMps), start, Radians(0), policy, VehicleKind.Car)

  override def limits: Vector[Limit] = Vector(Limit.separation(Metres(3)))

  override def series: Vector[Series] = Vector(offPlaces, apart, unseen)

  override def measures: Vector[Measure] =
    val settled = Window.After(SettlingS)
    Vector(
      offPlaces.rms("off places", settled),
      apart.mean("between cars", settled),
      apart.sd("its sd", settled),
      unseen.timeAbove("out of view", sightM)
    )

  override def note: String =
    s"Off places: distance of the drones to their places after the first ${SettlingS.significant(3)} s, root mean square. " +
      "Between cars: in the plane. Out of view: how long a car " +
      s"had no drone within ${sightM.significant(3)} m, seen from above."

  private def offPlaces =
    val (ahead, right) = places.unzip
    Series.of("off places, rms", "m", OffSlots(circuit, IArray.from(ahead), IArray.from(right)))

  private def apart = Series.of("between the cars", "m", Apart(Lead, Rear), Some(Bound("asked for", gapM)))

  private def unseen =
    Series.of("from a car to its nearest drone", "m", FromDrones, Some(Bound("in view", sightM)))

object Convoy:
  // Indices of the vehicles. The drones follow the leading car, as the scores of slots require.
  private val Lead = 0
  private val Rear = 4

  /** Horizontal distance from each car to its nearest drone, m; the larger of the two. */
  private case object FromDrones extends Quantity:
    def of(positions: Positions): Double = nearest(positions, Lead).max(nearest(positions, Rear))

    private def nearest(positions: Positions, car: Int): Double =
      var least = Double.PositiveInfinity
      for drone <- Lead + 1 until Rear do least = least.min(positions.distanceM(car, drone))
      least

  /** Time ahead for which the cars are steered, s: about a driver's time for a turn, plus the tyres' lag. */
  private val AheadS = 1.0

  /** Time in which the vehicles gain speed after the start, s; measures leave it out. */
  private val SettlingS = 10.0
