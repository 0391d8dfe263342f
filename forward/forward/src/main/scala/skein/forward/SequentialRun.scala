package skein.forward

/** The loop [[LoopTiming.Sequential]] in virtual time: vehicles are read in sequence. */
private[skein] final class SequentialRun(timing: LoopTiming.Sequential, protected val world: RolloutWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val observation            = RolloutView(world)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, timing.steering, 0, decidesFirst = true, this))

  def start(): Unit = world.schedule(0, RolloutWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    val _ = world.ask(0, 0, number)

  def answered(vehicle: Int, question: Int): Unit =
    val step = world.stepOf(vehicle, question)
    observation.take(vehicle, question)
    if vehicle + 1 < world.count then
      val _ = world.ask(0, vehicle + 1, step)
    else
      observation.takeSent(controllers)
      for controller <- controllers do controller.offer(observation)
      goOn(step)

  def timedOut(vehicle: Int, question: Int): Unit = goOn(world.stepOf(vehicle, question))

  private def goOn(step: Int): Unit = world.schedule(world.nowNs + periodNs, RolloutWorld.Tick, 0, step + 1)
