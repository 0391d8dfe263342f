package skein.forward

/** The loop [[LoopTiming.Futures]] in virtual time: one task per vehicle and period. */
private[skein] final class FuturesRun(timing: LoopTiming.Futures, protected val world: RolloutWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val most                   = world.count * timing.asking.window
  private val observation            = RolloutView(world)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = true, this))

  /** For each request to a vehicle, by [[RolloutWorld.slot]]: the request of that task to the previous
    * vehicle.
    */
  private val before = Array.ofDim[Int](world.count * world.ring)

  // The vehicle whose task of the current step begins next (their number if all have begun), and the step
  // that waits after it.
  private var next, current = 0
  private var waiting       = FuturesRun.Nothing
  private var underWay      = 0

  def start(): Unit =
    next = world.count; waiting = FuturesRun.Nothing; underWay = 0
    world.schedule(0, RolloutWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    world.schedule((number + 1) * periodNs, RolloutWorld.Tick, 0, number + 1)
    if waiting == FuturesRun.Nothing then waiting = number
    begin()

  /** Begins waiting tasks while the limit of unfinished tasks allows. */
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
        observation.take(read, its)
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
