package skein.forward

/** [[LoopTiming.Stream]]. */
private[skein] final class StreamRun(timing: LoopTiming.Stream, world: DuelWorld)
    extends LoopRun,
      PeriodicQuestions.Seen:

  private val patienceNs = Nanos.of(timing.patienceS)
  private val questions  =
    Array.tabulate(world.count)(PeriodicQuestions(world, _, Nanos.of(timing.periodS), timing.asking, this))
  val controllers: Array[Controller] =
    val interval = Nanos.of(timing.periodS) - Nanos.of(timing.toleranceS)
    Array.tabulate(world.count)(Controller(world, _, timing.steering, interval, timing.decideThenPace, this))

  // What is joined, as skein.flow.JoinLatest keeps it.
  private val sight               = DuelObservation(world.count)
  private val validAt, receivedAt = Array.ofDim[Long](world.count)
  private val known, renewed      = Array.ofDim[Boolean](world.count)
  private var patienceEnds        = StreamRun.NoEnd

  def start(): Unit =
    for vehicle <- world.vehicles.indices do
      known(vehicle) = false; renewed(vehicle) = false
    patienceEnds = StreamRun.NoEnd
    questions.foreach(_.start())

  def tick(vehicle: Int, number: Int): Unit = questions(vehicle).tick(number)

  def answered(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = true)

  def timedOut(vehicle: Int, question: Int): Unit = questions(vehicle).ended(question, answered = false)

  def seen(vehicle: Int, question: Int): Unit =
    val at      = world.slot(vehicle, question)
    val isNewer =
      !known(vehicle) || world.validAtNs(at) > validAt(vehicle) || world.sentAtNs(at) > receivedAt(vehicle)
    if isNewer then
      known(vehicle) = true; renewed(vehicle) = true
      validAt(vehicle) = world.validAtNs(at); receivedAt(vehicle) = world.receivedAtNs(at)
      sight.take(world, vehicle, question)
      if all(known) then
        if all(renewed) || patienceNs <= 0 then join()
        else if patienceEnds == StreamRun.NoEnd then
          patienceEnds = world.nowNs + patienceNs
          world.schedule(patienceEnds, DuelWorld.Patience, 0, 0)

  override def patienceOver(): Unit = if patienceEnds == world.nowNs then join()

  private def join(): Unit =
    java.util.Arrays.fill(renewed, false)
    patienceEnds = StreamRun.NoEnd
    sight.takeSent(controllers)
    for controller <- controllers do controller.offer(sight)

  private def all(flags: Array[Boolean]): Boolean =
    var i = 0
    while i < flags.length && flags(i) do i += 1
    i == flags.length

private[skein] object StreamRun:
  private val NoEnd = -1L
