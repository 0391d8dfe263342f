package skein.lanes

import skein.forward.*
import skein.lanes.plant.LaneQuadrotors
import skein.policy.Action
import skein.simd.LaneMath
import skein.units.eachBelow

/** Steps the vehicles of many worlds together ([[skein.forward.SteppedVehicles]]), while each world has its
  * own [[Rollout]]. Before each step of physics, every rollout handles the events since the previous step. A
  * vehicle that is stepped alone handles events in that order too, so only the stepping differs; loops,
  * delays and policies are those of the scalar reference. Mutable.
  *
  * @param worlds maximum number of worlds simulated together
  * @param each number of vehicles per world
  */
private final class SteppedRollouts private (
    model: VelocityResponse,
    stepS: Double,
    hoveredS: Double,
    val worlds: Int,
    each: Int,
    vehicles: SteppedVehicles
):
  private val stepNs    = Nanos.of(stepS)
  private val hoveredNs = Nanos.of(hoveredS)
  private val nextNs    = Array.ofDim[Long](worlds)

  /** End of the last step, ns since the flight's start. */
  private var steppedTo = 0L

  /** The response for one world's rollout: creates handles of that world's vehicles. */
  def vehiclesOf(world: Int): VelocityResponse =
    model.sensors.fold(Places(world))(SensedResponse(Places(world), _))

  /** Simulates worlds to their end.
    *
    * @param start begins the rollout of a world, with the vehicles of [[vehiclesOf]]
    * @throws InterruptedException if the thread is interrupted, which is checked at every step, because a
    *   simulation may take many seconds
    */
  def fly(count: Int)(start: Int => Rollout): Unit =
    steppedTo = Math.floorDiv(hoveredNs, stepNs) * stepNs - hoveredNs
    val rollouts = Array.tabulate(count)(start)
    java.util.Arrays.fill(nextNs, 0L)
    vehicles.use(count * each)
    var flying = count
    while flying > 0 do
      if Thread.interrupted() then throw InterruptedException()
      val until = steppedTo + stepNs
      flying = 0
      eachBelow(count): world =>
        if nextNs(world) < until then nextNs(world) = rollouts(world).flyUntil(until)
        if nextNs(world) != Rollout.Never then flying += 1
      vehicles.step()
      steppedTo = until

  private final class Places(world: Int) extends VelocityResponse:
    private var next                                      = world * each
    override def handoverS: Double                        = model.handoverS
    override def regardsYaw: Boolean                      = model.regardsYaw
    override def predictor: skein.vehicle.VehicleModel[?] = model.predictor
    def create(): Vehicle                                 =
      next += 1
      Flying(next - 1)

  /** One vehicle as the loops see it, by its index among all. */
  private final class Flying(place: Int) extends SteppedVehicle:
    private var down         = 0f
    protected var sinceStepS = 0.0

    def start(x: Double, y: Double, z: Double): Unit =
      originX = x
      originY = y
      down = z.toFloat
      vehicles.hover(place, z)

    def act(action: Action): Unit = action.byVelocity match
      case Action.VelocityAt(north, east, _, _) =>
        vehicles.command(place, north.toFloat, east.toFloat, down)
      case other => throw UnsupportedOperationException(s"this vehicle does not perform $other")

    def advance(timeS: Double): Unit =
      vehicles.read(place, state)
      sinceStepS = (Nanos.of(timeS) - steppedTo) * 1e-9

private object SteppedRollouts:
  /** Creates rollouts for these vehicles; None if they cannot be stepped together. */
  def of(model: VelocityResponse, vehicles: Vector[RolloutAgent]): Option[SteppedRollouts] =
    val each   = vehicles.size
    val worlds = worldsOf(model, each)
    model.body match
      case stepped: SteppedResponse =>
        val flown = stepped.together(worlds * each)
        Some(new SteppedRollouts(model, stepped.stepS, stepped.hoveredS, worlds, each, flown))
      case of: QuadrotorResponse if fliesByLanes(of, vehicles) =>
        val flown = LaneQuadrotors.of(of.quadrotor).fold(sys.error, identity)
        Some(new SteppedRollouts(model, of.quadrotor.stepS, of.hoveredS, worlds, each, flown))
      case _ => None

  /** The engine for such vehicles; None if they cannot be stepped together. */
  def engine(model: VelocityResponse, vehicles: Vector[RolloutAgent]): Option[Engine] =
    model.body match
      case _: SteppedResponse => Some(Engine(Engine.Kind.Bodies, s"vehicles side by side; $Loops"))
      case quadrotor: QuadrotorResponse if fliesByLanes(quadrotor, vehicles) =>
        Some(Engine(
          Engine.Kind.Quadrotors,
          s"SIMD, ${LaneMath.LANES} quadrotors at a time; $Loops",
          LaneMath.LANES
        ))
      case _ => None

  /** Number of worlds that are stepped together.
    *
    * @param each number of vehicles per world
    */
  def worldsOf(model: VelocityResponse, each: Int): Int = model.body match
    case _: SteppedResponse => (MostVehicles / each).max(1)
    case _                  => LaneQuadrotors.VEHICLES / each

  private val Loops = "their loops by the scalar engine"

  private def fliesByLanes(model: QuadrotorResponse, vehicles: Vector[RolloutAgent]) =
    LaneSupport.present.isRight && LaneDynamics.of(model).isRight &&
      LaneDynamics.isHighEnough(model, vehicles).isRight

  private val MostVehicles = 64
