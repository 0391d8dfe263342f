package skein.forward

/** The loop [[LoopTiming.Paused]] in virtual time: the world waits for the controller. */
private[skein] final class PausedRun(timing: LoopTiming.Paused, protected val world: RolloutWorld)
    extends LoopRun:
  private val periodNs               = Nanos.of(timing.periodS)
  private val observation            = RolloutView(world)
  val controllers: Array[Controller] =
    Array.tabulate(world.count)(Controller(world, _, Steering(), 0, decidesFirst = true, this))

  def start(): Unit = world.schedule(0, RolloutWorld.Tick, 0, 0)

  def tick(vehicle: Int, number: Int): Unit =
    for vehicle <- world.vehicles.indices do
      observation.take(vehicle, world.readNow(vehicle, number))
    observation.takeSent(controllers)
    for agent <- world.vehicles.indices do
      val controller = controllers(agent)
      controller.decide(observation)
      controller.sentNow()
      world.commandNow(agent, controller.decidedAction)
    world.schedule((number + 1) * periodNs, RolloutWorld.Tick, 0, number + 1)

  def answered(vehicle: Int, question: Int): Unit = ()
  def timedOut(vehicle: Int, question: Int): Unit = ()
