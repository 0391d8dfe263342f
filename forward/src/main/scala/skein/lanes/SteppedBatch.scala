package skein.lanes

import skein.forward.*
import skein.signal.Kinematics
import skein.units.Vector3

/** Many worlds' vehicles fly side by side ([[skein.forward.SteppedVehicles]]), each world by its own
  * [[Rollout]] and in its own time: before each step of physics every rollout handles the events that fall
  * between the step before and this one. That is how one such vehicle meets them too, so that only the flight
  * itself is another's; loops, delays and policies, of any kind, are the scalar reference's. Mutable.
  *
  * @param batch worlds flown together
  * @param vehicles two for each
  */
private final class SteppedBatch(
    duel: Duel,
    timing: LoopTiming,
    model: VelocityResponse,
    stepS: Double,
    hoveredS: Double,
    val batch: Int,
    vehicles: SteppedVehicles
) extends DuelFlyer:
  import SteppedBatch.*

  private val stepNs    = Nanos.of(stepS)
  private val hoveredNs = Nanos.of(hoveredS)
  private val kept      = Array.tabulate(batch)(lane => KeptRollout(duel, timing, Places(lane)))
  private val rollouts  = Array.ofDim[Rollout](batch)
  private val nextNs    = Array.ofDim[Long](batch)

  /** The end of the last step, since the flight's start, ns. */
  private var steppedTo = 0L

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    for some <- numbers.grouped(batch) do
      steppedTo = Math.floorDiv(hoveredNs, stepNs) * stepNs - hoveredNs
      for lane <- some.indices do
        rollouts(lane) = kept(lane)(worlds, some(lane))
        rollouts(lane).start(worlds.key(some(lane)), captureRadiusM)
        nextNs(lane) = 0
      vehicles.use(some.length * Vehicles)
      flyAll(some.length)
      for lane <- some.indices do into.set(some(lane), rollouts(lane).outcome)

  private def flyAll(count: Int): Unit =
    var flying = count
    while flying > 0 do
      val until = steppedTo + stepNs
      flying = 0
      var lane = 0
      while lane < count do
        if nextNs(lane) < until then nextNs(lane) = rollouts(lane).flyUntil(until)
        if nextNs(lane) != Rollout.Never then flying += 1
        lane += 1
      vehicles.step()
      steppedTo = until

  /** Where the vehicles of one world are. */
  private final class Places(lane: Int) extends VelocityResponse:
    private var next                                      = lane * Vehicles
    override def handoverS: Double                        = model.handoverS
    override def predictor: skein.vehicle.VehicleModel[?] = model.predictor
    def create(): Vehicle                                 =
      next += 1
      Flying(next - 1)

  /** One of the vehicles, as the loops know it. */
  private final class Flying(place: Int) extends Vehicle:
    private var originX, originY = 0.0
    private var down             = 0f
    private var sinceStep        = 0.0

    def start(x: Double, y: Double, z: Double): Unit =
      originX = x
      originY = y
      down = z.toFloat
      vehicles.hover(place, z)

    def command(vx: Double, vy: Double): Unit = vehicles.command(place, vx.toFloat, vy.toFloat, down)

    def advance(timeS: Double): Unit = sinceStep = (Nanos.of(timeS) - steppedTo) * 1e-9

    def x: Double  = originX + ownX
    def y: Double  = originY + ownY
    def vx: Double = vehicles.vx(place) + vehicles.ax(place) * sinceStep
    def vy: Double = vehicles.vy(place) + vehicles.ay(place) * sinceStep

    override def seenX: Double  = ownX.toFloat + originX
    override def seenY: Double  = ownY.toFloat + originY
    override def seenVx: Double = vx.toFloat
    override def seenVy: Double = vy.toFloat

    override def seen: Kinematics =
      Kinematics(
        Vector3(seenX, seenY, along(vehicles.z(place), vehicles.vz(place), vehicles.az(place)).toFloat),
        Vector3(seenVx, seenVy, (vehicles.vz(place) + vehicles.az(place) * sinceStep).toFloat),
        vehicles.orientation(place),
        vehicles.angularVelocityFrd(place)
      )

    private def ownX: Double = along(vehicles.x(place), vehicles.vx(place), vehicles.ax(place))
    private def ownY: Double = along(vehicles.y(place), vehicles.vy(place), vehicles.ay(place))
    private def along(from: Double, speed: Double, acceleration: Double): Double =
      from + speed * sinceStep + acceleration * (sinceStep * sinceStep / 2)

private object SteppedBatch:
  private val Vehicles = 2

  /** AirSim's quadrotors, by lanes. */
  def of(duel: Duel, timing: LoopTiming, model: QuadrotorResponse): SteppedBatch =
    SteppedBatch(
      duel,
      timing,
      model,
      model.quadrotor.stepS,
      model.hoveredS,
      QuadrotorKernel.VEHICLES / Vehicles,
      KernelVehicles()
    )

  /** Of any kind. */
  def of(duel: Duel, timing: LoopTiming, model: SteppedResponse): SteppedBatch =
    SteppedBatch(duel, timing, model, model.stepS, model.hoveredS, Worlds, model.together(Worlds * Vehicles))

  /** Whose state fits the nearest memory. */
  private val Worlds = 32
