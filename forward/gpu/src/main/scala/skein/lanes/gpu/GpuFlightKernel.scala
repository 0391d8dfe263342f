package skein.lanes.gpu

import skein.forward.RolloutAgent
import skein.gpu.{Gpu, GpuBuffer, GpuKernel, Ptx, PtxExpressions, Variables}
import skein.lanes.PreparedTeam
import skein.lanes.score.{OfMoment, ScoreLanes}
import skein.lanes.timetable.Timetable

/** Runs the operations of [[skein.lanes.timetable.TimetableKernel]] on a GPU. A thread simulates one
  * candidate in one episode; the threads of a block simulate candidates in one episode, so they do not
  * diverge. Expressions and single operations are those of the CPU, so outcomes are identical, to the bit.
  *
  * @param sides number of values that define the policies of each side
  * @param scores the flights' scores
  * @param agents the agents of one candidate; all candidates share their common properties
  */
private[lanes] abstract class GpuFlightKernel(
    gpu: Gpu,
    layout: GpuLayout,
    sides: Vector[Int],
    protected val scores: ScoreLanes,
    agents: Vector[RolloutAgent]
):
  import GpuFlightKernel.*

  /** The part of the kernel that depends on the kind of flight. */
  protected trait Body:
    def vehicles: Vector[GpuVehicle]

    /** The predictions from readings; empty in loops that do not predict. */
    def predictions: Vector[GpuPrediction]

    def start(): Unit

    def show(now: GpuRecord): Unit
    def decide(self: Int, now: GpuRecord): Unit

    /** Register of a quantity's parameter; see [[ScoreLanes.Source.Parameter]]. */
    def quantity(number: Int, parameter: Int): Int

    /** Registers of a world's [[efforts]], in the order of the results. */
    def besides: Vector[Int] = Vector.empty

  /** Creates the part of the kernel that depends on the kind of flight.
    *
    * @param numbers the register of a value, for each side
    */
  protected def body(code: Ptx, numbers: Vector[Int => Int]): Body

  protected def withVelocity: Boolean

  protected def moreBytes: Int = 0

  /** Number of results in addition to the scores: the efforts, in the order in which they are scored. */
  protected def efforts: Int = 0

  /** For each side, the sets of values that define the policies of candidates, concatenated, and the index of
    * each candidate's set.
    */
  def sidesOf(teams: Array[PreparedTeam]): Vector[(Array[Float], Array[Int])]

  private lazy val kernel: GpuKernel = gpu.kernel(text, Name)

  /** Simulates all candidates in all episodes.
    *
    * @return the accumulators of the scores, then the efforts; each by episode, then by candidate
    */
  def fly(episodes: Vector[GpuEpisodes.Held], teams: Array[PreparedTeam]): Array[Float] =
    val candidates            = teams.length
    val worlds                = episodes.size * candidates
    val outcomes              = scores.initial.size + efforts
    val buffers               = collection.mutable.ArrayBuffer.empty[GpuBuffer]
    def here(made: GpuBuffer) =
      buffers += made
      made
    try
      val into   = here(gpu.buffer(outcomes.toLong * worlds))
      val blocks = blocksOf(episodes, candidates)
      val read   = sidesOf(teams).zip(sides).flatMap: (told, count) =>
        Vector(here(gpu.buffer(tiled(told._1, count))), here(gpu.buffer(told._2)))
      val arguments =
        here(gpu.buffer(blocks)) +: (read ++ Vector(worlds, into))
      kernel(blocks.length / BlockWords, BlockWorlds, arguments*)
      into.floats()
    finally buffers.foreach(_.close())

  /** The words of all blocks. Each block has the address of its episode's operations, in two words; their
    * number, and the words per operation; the first world, the number of worlds, and the candidate of the
    * first world; and an unused word that aligns addresses to eight bytes.
    */
  private def blocksOf(episodes: Vector[GpuEpisodes.Held], candidates: Int): Array[Int] =
    val words = Array.newBuilder[Int]
    for (episode, number) <- episodes.zipWithIndex; first <- 0 until candidates by BlockWorlds do
      words += episode.buffer.address.toInt
      words += (episode.buffer.address >>> 32).toInt
      words += episode.size
      words += episode.stride
      words += number * candidates + first
      words += BlockWorlds.min(candidates - first)
      words += first
      words += 0
    words.result()

  /** Interleaves sets of values, so that neighbouring threads read neighbouring words. */
  private def tiled(numbers: Array[Float], count: Int): Array[Float] =
    val sets = if count == 0 then 0 else numbers.length / count
    val made = Array.ofDim[Float]((sets + Tile - 1) / Tile * Tile * count)
    for set <- 0 until sets; number <- 0 until count do
      made((set / Tile * count + number) * Tile + set % Tile) = numbers(set * count + number)
    made

  lazy val text: String = Writer().module

  private final class Writer:
    private val code = Ptx(
      Name,
      Seq("blocks" -> Ptx.Kind.Address) ++
        sides.indices.flatMap(side =>
          Seq(s"numbers$side" -> Ptx.Kind.Address, s"flownBy$side" -> Ptx.Kind.Address)
        ) ++
        Seq("worlds" -> Ptx.Kind.Whole, "into" -> Ptx.Kind.Address),
      layout.bytes + moreBytes
    )
    private val end, loop, next, stored = code.label()
    private val labels                  = GpuTimetable.Labels(layout.vehicles)
    private val kept                    = Variables(code, scores.initial)

    // Number of evaluations of each stage, for scores that need the weight of a value.
    private val counted = Variables(code, scores.judged.map(_ => 0f))

    def module: String =
      code.ownBase(): Unit
      val block = code.address(code.argument("blocks"), code.special("ctaid.x"), BlockWords)
      val own   = code.special("tid.x")
      code.goIf(code.compareWholes("ge", own, code.loadWhole(block, 5)), end)
      val world     = code.wholes("add.s32", code.loadWhole(block, 4), own)
      val candidate = code.wholes("add.s32", code.loadWhole(block, 6), own)
      val record    = code.loadAddress(block, 0)
      val left      = code.loadWhole(block, 2)
      val bytes     = code.wide(code.loadWhole(block, 3), 4)
      val views     = code.advanced(record, left, bytes)
      val flying    = body(code, Vector.tabulate(sides.size)(numbersOf(_, candidate)))
      flying.vehicles.foreach(_.start())
      flying.start()
      kept.start()
      counted.start()
      val label     = code.loadWhole(record)
      val nextLabel = code.fresh()
      code.place(loop)
      code.goIf(code.compareWhole("le", left, 0), stored)
      // The views follow the last operation.
      val following = code.sum(record, bytes)
      code.loadWhole(following, 0, nextLabel): Unit
      val now     = GpuRecord(code, record, views)
      val targets =
        Vector.fill(if flying.predictions.isEmpty then labels.predict(0) else labels.count)(code.label())
      code.goTo(label, targets)
      for self <- 0 until layout.vehicles do
        val vehicle = flying.vehicles(self)
        part(targets(labels.look(self, withVelocity = false)))(look(vehicle, now, withVelocity = false))
        // Predictions start from velocities, even if no policy reads them.
        part(targets(labels.look(self, withVelocity = true))):
          look(vehicle, now, withVelocity || flying.predictions.nonEmpty)
        part(targets(labels.act(self))):
          val at = now.place(1)
          vehicle.act(now, code.loadOwn(at, 0), code.loadOwn(at, 1))
        part(targets(labels.decide(self)))(flying.decide(self, now))
        if flying.predictions.nonEmpty then predict(self, flying.predictions(self), now, targets)
      part(targets(labels.show))(flying.show(now))
      part(targets(labels.score))(score(flying, now))
      code.place(next)
      code(s"mov.b64 %rd$record, %rd$following")
      code(s"mov.b32 %r$label, %r$nextLabel")
      code(s"add.s32 %r$left, %r$left, -1")
      code.go(loop)
      code.place(stored)
      store(world, flying.besides)
      code.place(end)
      code("ret")
      code.module

    private def part(label: String)(body: => Unit): Unit =
      code.place(label)
      body
      code.go(next)

    /** Register of a value of this thread's candidate. Only few values stay in registers. */
    private def numbersOf(side: Int, candidate: Int): Int => Int =
      val set    = code.loadWhole(code.address(code.argument(s"flownBy$side"), candidate))
      val tile   = code.wholes("shr.s32", set, TileBits.toString)
      val within = code.wholes("and.b32", set, (Tile - 1).toString)
      val at = code.address(code.address(code.argument(s"numbers$side"), tile, sides(side) * Tile), within)
      if sides(side) <= MostInRegisters then
        val registers = Vector.tabulate(sides(side))(number => code.load(at, number * Tile))
        registers(_)
      else number => code.load(at, number * Tile)

    private def look(vehicle: GpuVehicle, now: GpuRecord, withVelocity: Boolean): Unit =
      val seen = vehicle.look(now, withVelocity)
      val at   = now.place(1)
      for (value, i) <- seen.zipWithIndex do code.storeOwn(value, at, i)

    private def predict(self: Int, prediction: GpuPrediction, now: GpuRecord, targets: Vector[String]): Unit =
      part(targets(labels.predict(self))):
        val at = now.place(1)
        prediction.begin(now, Vector.tabulate(Timetable.Read)(code.loadOwn(at, _)))
      part(targets(labels.carry(self))):
        val command         = now.field(1)
        val (atRest, knows) = (code.label(), code.label())
        val north, east     = code.fresh()
        code.goIf(code.compareWhole("lt", command, 0), atRest)
        val at = code.own(command)
        code.move(code.loadOwn(at, 0), north)
        code.move(code.loadOwn(at, 1), east)
        code.go(knows)
        code.place(atRest)
        code.constant(0f, north): Unit
        code.constant(0f, east): Unit
        code.place(knows)
        prediction.go(now, north, east)
      part(targets(labels.predicted(self))):
        val at   = now.place(1)
        val seen = prediction.end(now)
        for i <- 0 until (if withVelocity then 4 else 2) do code.storeOwn(seen(i), at, i)

    private def score(flying: Body, now: GpuRecord): Unit =
      val time = now.time(0)
      for stage <- scores.stages.reverse do
        val earlier = code.label()
        code.goIf(code.compare("lt", code.constant(stage.afterS), time), earlier, holds = false)
        add(flying, stage, now.seen(), time)
        code.go(next)
        code.place(earlier)

    private def add(flying: Body, stage: ScoreLanes.Stage, seen: Int => Int, time: Int): Unit =
      import ScoreLanes.Source
      val one = code.constant(1)
      for number <- stage.judged if scores.hasShare(number) do
        code.move(code.two("add.rn", counted(number), one), counted(number))
      val values = PtxExpressions.write(code, stage.function.nodes)(
        input =>
          scores.source(stage.function.inputs(input)) match
            case Source.Reading(vehicle, field)      => code.loadOwn(seen(vehicle), field)
            case Source.Altitude(vehicle)            => code.constant(agents(vehicle).altitudeDownM.toFloat)
            case Source.Kept(place)                  => kept(place)
            case Source.Parameter(number, parameter) => flying.quantity(number, parameter)
            case ofEnd                               => throw IllegalStateException(s"a quantity of $ofEnd")
        ,
        parameter =>
          if parameter == ScoreLanes.Time then time
          else
            val number = parameter - ScoreLanes.ownParameter(0)
            scores.judged(number).reduction match
              case OfMoment.FirstWithin(limit) => code.constant(limit.toFloat)
              case _                           => code.two("div.rn", one, counted(number))
      )
      for (value, place) <- values.zip(stage.places) do code.move(value, kept(place))

    private def store(world: Int, besides: Vector[Int]): Unit =
      val worlds = code.argument("worlds")
      var at     = code.address(code.argument("into"), world)
      for value <- scores.initial.indices.map(kept(_)) ++ besides do
        code.store(value, at)
        at = code.address(at, worlds)

private[lanes] object GpuFlightKernel:
  private val Name = "flights"

  /** Number of worlds in a block, which share one episode. */
  private val BlockWorlds = 128
  private val BlockWords  = 8
  private val Tile        = 32
  private val TileBits    = 5

  /** Maximum number of a side's values that are kept in registers; the others are loaded at each use. */
  private val MostInRegisters = 16

  /** Index of a score among a world's results, and its final conversion.
    *
    * @param scoredAtS times of the scores, s
    */
  final class Outcome(scores: ScoreLanes, number: Int, scoredAtS: Array[Float]):
    private val of    = scores.judged(number)
    private val count = scoredAtS.count(of.counts(_))

    val place: Int                = scores.places(number + 1) - 1
    def apply(kept: Float): Float = ScoreLanes.value(of, kept, count)
