package skein.forward

/** A loop while it flies: what it does when something happens. One case of [[LoopTiming]] each. Mutable. */
private[skein] trait LoopRun extends Controller.OnSent:
  import DuelWorld.*

  protected def world: DuelWorld

  def controllers: Array[Controller]

  def start(): Unit

  /** Handles an event of a question, or of the loop's own clock. */
  final def handle(event: Long): Unit =
    val vehicle = vehicleOf(event)
    val number  = numberOf(event)
    kindOf(event) match
      case Tick     => tick(vehicle, number)
      case Sampled  => world.sampled(vehicle, number)
      case Answered =>
        world.received(vehicle, number)
        answered(vehicle, number)
      case TimedOut => timedOut(vehicle, number)
      case Patience => patienceOver()
      case Due      => due(number)

  /** It is time for what was scheduled as `Tick`. */
  def tick(vehicle: Int, number: Int): Unit

  def answered(vehicle: Int, question: Int): Unit

  def timedOut(vehicle: Int, question: Int): Unit

  /** It is time for what was scheduled as `Patience`. */
  def patienceOver(): Unit = ()

  /** It is time for what was scheduled as `Due`. */
  def due(number: Int): Unit = ()

  def sent(agent: Int, number: Int, headingRad: Double, speedMps: Double): Unit = ()

  /** A command was answered because a newer one has replaced it. */
  def replaced(agent: Int, number: Int): Unit = ()

/** [[LoopTiming.Paused]]. */
private[skein] final class PausedRun(timing: LoopTiming.Paused, protected val world: DuelWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val observation            = DuelObservation(world.count)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, Steering(), 0, decidesFirst = true, this))

  def start(): Unit = world.schedule(0, DuelWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    for vehicle <- world.vehicles.indices do
      observation.take(world, vehicle, world.readNow(vehicle, number))
    observation.takeSent(controllers)
    for agent <- world.vehicles.indices do
      controllers(agent).decide(observation)
      controllers(agent).sentNow()
      world.commandNow(agent, controllers(agent).decidedHeading, controllers(agent).decidedSpeed)
    world.schedule((number + 1) * periodNs, DuelWorld.Tick, 0, number + 1)

  def answered(vehicle: Int, question: Int): Unit = ()
  def timedOut(vehicle: Int, question: Int): Unit = ()

/** [[LoopTiming.Sequential]]. */
private[skein] final class SequentialRun(timing: LoopTiming.Sequential, protected val world: DuelWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val observation            = DuelObservation(world.count)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = true, this))

  def start(): Unit = world.schedule(0, DuelWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    val _ = world.ask(0, 0, number)

  def answered(vehicle: Int, question: Int): Unit =
    val step = world.stepOf(vehicle, question)
    observation.take(world, vehicle, question)
    if vehicle + 1 < world.count then
      val _ = world.ask(0, vehicle + 1, step)
    else
      observation.takeSent(controllers)
      for controller <- controllers do controller.offer(observation)
      goOn(step)

  def timedOut(vehicle: Int, question: Int): Unit = goOn(world.stepOf(vehicle, question))

  private def goOn(step: Int): Unit = world.schedule(world.nowNs + periodNs, DuelWorld.Tick, 0, step + 1)

/** [[LoopTiming.Futures]]. */
private[skein] final class FuturesRun(timing: LoopTiming.Futures, protected val world: DuelWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val most                   = world.count * timing.asking.window
  private val observation            = DuelObservation(world.count)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = true, this))

  /** The same task's question to the vehicle before, by its question to a vehicle. */
  private val before = Array.ofDim[Int](world.count * world.ring)

  // Whose task of the current step begins next (the number of vehicles: all have), and the step that waits
  // behind it.
  private var next, current = 0
  private var waiting       = FuturesRun.Nothing
  private var underWay      = 0

  def start(): Unit =
    next = world.count; waiting = FuturesRun.Nothing; underWay = 0
    world.schedule(0, DuelWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    world.schedule((number + 1) * periodNs, DuelWorld.Tick, 0, number + 1)
    if waiting == FuturesRun.Nothing then waiting = number
    begin()

  /** Begins as many tasks as may be under way. */
  private def begin(): Unit =
    while underWay < most && (next < world.count || waiting != FuturesRun.Nothing) do
      if next == world.count then
        next = 0
        current = waiting
        waiting = FuturesRun.Nothing
      underWay += 1
      val _ = world.ask(next, 0, current)
      next += 1

  def answered(vehicle: Int, question: Int): Unit =
    val agent = world.askerOf(vehicle, question)
    if vehicle + 1 < world.count then
      val asked = world.ask(agent, vehicle + 1, world.stepOf(vehicle, question))
      before(world.slot(vehicle + 1, asked)) = question
    else
      var read = vehicle
      var its  = question
      while read >= 0 do
        observation.take(world, read, its)
        its = before(world.slot(read, its))
        read -= 1
      observation.takeSent(controllers)
      controllers(agent).offer(observation)
      ended()

  def timedOut(vehicle: Int, question: Int): Unit = ended()

  private def ended(): Unit =
    underWay -= 1
    begin()

private[skein] object FuturesRun:
  private val Nothing = -1
