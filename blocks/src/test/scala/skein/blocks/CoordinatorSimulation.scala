package skein.blocks

import scala.collection.immutable.ArraySeq
import scala.collection.mutable
import skein.signal.SplitMix64

/** Coordinator, ledger and workers over a network that loses, doubles and delays, on a clock of their own. */
final class CoordinatorSimulation(seed: Long, workers: Int, blocks: Int, meanSeconds: Double = 5.0):
  private val patienceNanos = (60 * meanSeconds * 1e9).toLong

  import CoordinatorSimulation.bytes

  private val random = SplitMix64(seed)
  private val events = mutable.PriorityQueue.empty[(Long, Long, () => Unit)](using
    Ordering.by[(Long, Long, () => Unit), (Long, Long)](event => (event._1, event._2)).reverse
  )
  private var now      = 0L
  private var serial   = 0L
  private var state    = Coordinator(patienceNanos = patienceNanos)
  private var run      = 0
  private var cutUntil = Map.empty[String, Long]

  /** First answers by block, as a ledger keeps them: they outlive the coordinator. */
  val ledger: mutable.HashMap[BlockKey, ArraySeq[Byte]] = mutable.HashMap.empty
  var acceptedTwice                                     = 0
  var messages                                          = 0L
  var usefulNanos                                       = 0L
  var decidingNanos                                     = 0L
  var deaths                                            = 0
  def counts: Coordinator.Counts                        = state.counts
  def seconds: Double                                   = now * 1e-9

  private val work = Vector.tabulate(blocks)(number => bytes(s"block $number"))

  /** What the coordinator does, and how long it takes. */
  private def deciding[A](body: => A): A =
    val begun = System.nanoTime()
    try body
    finally decidingNanos += System.nanoTime() - begun

  private def at(time: Long)(event: => Unit): Unit =
    serial += 1
    events.enqueue((time, serial, () => event))

  private def exponential(mean: Double) = -mean * math.log(1 - random.nextDouble())

  private def second = 1_000_000_000L

  /** A message: late, now and then twice, now and then never; between a worker and the coordinator. */
  private def send(worker: String)(arrives: => Unit): Unit =
    messages += 1
    def once() =
      at(now + (exponential(0.02) * second).toLong)(if cutUntil.getOrElse(worker, 0L) <= now then arrives)
    if random.nextDouble() > 0.02 then once()
    if random.nextDouble() < 0.02 then once()

  private final class Worker(val name: String, speed: Double):
    private var isAlive = true
    private var held    = Vector.empty[Block]
    private var busy    = false

    def die(): Unit = isAlive = false

    def beat(): Unit = if isAlive && !isDone then
      ask()
      at(now + 2 * second)(beat())

    private def ask(): Unit =
      val holding = held.map(_.number).toSet
      val toRun   = run
      send(name):
        if toRun == run then
          val (next, block) = deciding(state.joined(name, 1).asked(name, holding, now))
          state = next
          block.foreach(one => send(name)(if toRun == run then take(one)))

    private def take(block: Block): Unit =
      if isAlive && !held.exists(_.number == block.number) && held.size < Coordinator.MostHeld then
        held :+= block
        compute()

    private def compute(): Unit = if !busy && held.nonEmpty then
      busy = true
      val block = held.head
      val toRun = run
      val took  = (exponential(meanSeconds) / speed * second).toLong
      at(now + took):
        if isAlive then
          busy = false
          held = held.filterNot(_.number == block.number)
          val answer = CoordinatorSimulation.answer(block.work)
          send(name)(if toRun == run then answered(name, block.number, answer, took))
          ask()
          compute()

  private def answered(worker: String, number: Long, answer: ArraySeq[Byte], took: Long): Unit =
    val (next, what) = deciding(state.answered(worker, number, took))
    state = next
    what match
      case Answer.First(block) =>
        if ledger.contains(block.key) then acceptedTwice += 1
        ledger(block.key) = answer
        usefulNanos += took
      case Answer.Repeated => ()

  def isDone: Boolean = ledger.size == blocks

  private var all     = Map.empty[String, Worker]
  private var born    = 0
  private def spawn() =
    born += 1
    val speed  = 0.2 / math.pow(1 - random.nextDouble(), 1 / 1.5) // heavy-tailed
    val worker = Worker(s"worker-$born", speed)
    all += worker.name -> worker
    at(now + (random.nextDouble() * 2 * second).toLong)(worker.beat())

  /** The coordinator's own death: what it knew but the ledger is gone. */
  private def restart(): Unit =
    run += 1
    state = Coordinator(patienceNanos = patienceNanos).offered(open)
  private def open = work.zipWithIndex.collect:
    case (bytes, number) if !ledger.contains(BlockKey.of(bytes)) => Block(run * 10_000_000L + number, bytes)

  /** @param deathsAnHour
    *   share of the workers that die in an hour; each is noticed after 10 s, and another comes
    * @param restarts
    *   of the coordinator, at these seconds
    */
  def fly(deathsAnHour: Double, partitionsAnHour: Double, restarts: Seq[Double]): Unit =
    for _ <- 0 until workers do spawn()
    state = state.offered(open)
    restarts.foreach(when => at((when * second).toLong)(restart()))
    def tick(): Unit = if !isDone then
      state = deciding(state.at(now))
      for name <- all.keys.toVector.sorted if random.nextDouble() < deathsAnHour / 3600 do
        deaths += 1
        all(name).die()
        all -= name
        at(now + 10 * second) { state = deciding(state.lost(name)) }
        spawn()
      for name <- all.keys.toVector.sorted if random.nextDouble() < partitionsAnHour / 3600 do
        cutUntil += name -> (now + (exponential(30) * second).toLong)
        at(now + 10 * second) { if cutUntil(name) > now then state = deciding(state.lost(name)) }
      at(now + second)(tick())
    tick()
    while !isDone && events.nonEmpty do
      val (time, _, event) = events.dequeue()
      now = time
      event()

object CoordinatorSimulation:
  def bytes(text: String): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(text.getBytes("UTF-8"))

  def answer(work: ArraySeq[Byte]): ArraySeq[Byte] = work.reverse
