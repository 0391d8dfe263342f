package skein.gpu

import java.nio.{ByteBuffer, ByteOrder}
import scala.collection.mutable

/** A GPU that interprets kernels thread by thread, according to the PTX specification, so that kernels are
  * tested on machines without a GPU. It is slow, supports the instructions that [[Ptx]] writes, and refuses
  * all others.
  */
final class InterpretedGpu extends Gpu:
  def name  = "an interpreter of PTX"
  def ranNs = 0L

  private val memory = mutable.HashMap.empty[Long, ByteBuffer]

  private def room(bytes: Long): (Long, ByteBuffer) =
    val address = (memory.size + 1L) << 32
    val held    = ByteBuffer.allocate(bytes.toInt).order(ByteOrder.LITTLE_ENDIAN)
    memory(address) = held
    (address, held)

  final class Buffer(val address: Long, held: ByteBuffer) extends GpuBuffer:
    def floats(): Array[Float] = Array.tabulate(held.capacity / 4)(i => held.getFloat(4 * i))
    def close(): Unit          = ()

  private[skein] def buffer(words: Long): GpuBuffer =
    val (address, held) = room(words * 4)
    // No code may rely on memory that was never written.
    for i <- 0L until words do held.putFloat(4 * i.toInt, Float.NaN): Unit
    Buffer(address, held)
  private[skein] def buffer(numbers: Array[Float]): GpuBuffer =
    buffer(numbers.map(java.lang.Float.floatToRawIntBits))
  private[skein] def buffer(numbers: Array[Int]): GpuBuffer =
    val (address, held) = room(numbers.length * 4L)
    for (number, i) <- numbers.zipWithIndex do held.putInt(4 * i, number): Unit
    Buffer(address, held)

  private[skein] def kernel(module: String, name: String): GpuKernel = new GpuKernel:
    private val program                                                = PtxProgram.parse(module, name)
    def apply(blocks: Int, threadsOfBlock: Int, arguments: Any*): Unit =
      val values = program.parameters.zip(arguments).toMap
      require(values.size == arguments.size, s"${program.parameters} for ${arguments.size} arguments")
      for block <- 0 until blocks; thread <- 0 until threadsOfBlock do
        PtxThread(program, values, at => memory(at & ~0xffffffffL), block, threadsOfBlock, thread).run()

/** A parsed kernel.
  *
  * @param parameters the kernel's parameters by name, in their order
  * @param labels index of the instruction after each label, keyed by name
  * @param tables targets of each table of branches
  */
private final case class PtxProgram(
    parameters: Vector[String],
    localBytes: Int,
    registers: Int,
    instructions: Array[PtxInstruction],
    labels: Map[String, Int],
    tables: Map[String, Vector[String]]
)

/** One instruction.
  *
  * @param guard the condition's number and its required value
  */
private final case class PtxInstruction(name: String, guard: Option[(Int, Boolean)], operands: Array[String])

private object PtxProgram:
  private val Label       = """(\w+):""".r
  private val Table       = """(\w+):\s*\.branchtargets (.*);""".r
  private val Parameter   = """\.param .*?(\w+)(?:\[\d+\])?,?""".r
  private val Local       = """\.local .* own\[(\d+)\];""".r
  private val Registers   = """\.reg .*<(\d+)>;""".r
  private val Instruction = """(?:@(!?)%p(\d+) )?([\w.]+)(?: (.*))?;""".r

  def parse(module: String, kernel: String): PtxProgram =
    require(module.contains(s".entry $kernel("), s"no kernel $kernel")
    val parameters            = Vector.newBuilder[String]
    val instructions          = mutable.ArrayBuffer.empty[PtxInstruction]
    val labels                = mutable.HashMap.empty[String, Int]
    val tables                = mutable.HashMap.empty[String, Vector[String]]
    var localBytes, registers = 0
    for line <- module.linesIterator.map(_.trim) do
      line match
        case "" | "(" | ")" | "{" | "}"                 => ()
        case Table(name, targets)                       => tables(name) = targets.split(", ").toVector
        case Label(name)                                => labels(name) = instructions.size
        case Parameter(name)                            => parameters += name
        case Local(bytes)                               => localBytes = bytes.toInt
        case Registers(count)                           => registers = registers.max(count.toInt)
        case Instruction(unless, guard, name, operands) =>
          instructions += PtxInstruction(
            name,
            Option(guard).map(number => (number.toInt, unless.isEmpty)),
            Option(operands).fold(Array.empty[String])(_.split(", "))
          )
        case other if other.startsWith(".") => ()
        case other                          => sys.error(s"not understood: $other")
    PtxProgram(parameters.result(), localBytes, registers, instructions.toArray, labels.toMap, tables.toMap)

private final class PtxThread(
    program: PtxProgram,
    arguments: Map[String, Any],
    memory: Long => ByteBuffer,
    block: Int,
    threadsOfBlock: Int,
    thread: Int
):
  private val floats     = Array.fill(program.registers)(Float.NaN)
  private val conditions = Array.ofDim[Boolean](program.registers)
  private val bits       = Array.ofDim[Int](program.registers)
  private val wide       = Array.ofDim[Long](program.registers)
  private val own        = ByteBuffer.allocate(program.localBytes).order(ByteOrder.LITTLE_ENDIAN)
  for i <- 0 until program.localBytes by 4 do own.putFloat(i, Float.NaN): Unit
  private var next = 0

  def run(): Unit =
    while next >= 0 do
      val now = program.instructions(next)
      next += 1
      if now.guard.forall((number, wanted) => conditions(number) == wanted) then execute(now)

  private def execute(now: PtxInstruction): Unit =
    val o              = now.operands
    def number(i: Int) = o(i).drop(if o(i).startsWith("%rd") then 3 else 2).toInt
    def f(i: Int)      =
      if o(i).startsWith("0f") then
        java.lang.Float.intBitsToFloat(java.lang.Integer.parseUnsignedInt(o(i).drop(2), 16))
      else floats(number(i))
    def r(i: Int)         = if o(i).startsWith("%") then bits(number(i)) else o(i).toInt
    def d(i: Int)         = wide(number(i))
    def p(i: Int)         = conditions(number(i))
    def toFloat(a: Float) = floats(number(0)) = a
    // A NaN has the bits of a GPU's NaN, which differ from those of a CPU.
    def rounded(a: Float)       = toFloat(if a.isNaN then java.lang.Float.intBitsToFloat(0x7fffffff) else a)
    def toBits(a: Int)          = bits(number(0)) = a
    def toWide(a: Long)         = wide(number(0)) = a
    def toCondition(a: Boolean) = conditions(number(0)) = a
    def address(i: Int): Long   =
      val PtxThread.Address(register, offset) = o(i): @unchecked
      wide(register.toInt) + offset.toLong
    def global(i: Int): (ByteBuffer, Int) =
      val at = address(i)
      (memory(at), at.toInt)
    now.name match
      case "ret"             => next = -1
      case "bra.uni" | "bra" => next = program.labels(o(0))
      case "brx.idx.uni"     => next = program.labels(program.tables(o(1))(r(0)))
      case "mov.f32"         => toFloat(f(1))
      case "mov.u32"         => toBits(o(1) match
          case "%ctaid.x" => block
          case "%ntid.x"  => threadsOfBlock
          case "%tid.x"   => thread)
      case "mov.b32" if o(0).startsWith("%f") => toFloat(java.lang.Float.intBitsToFloat(r(1)))
      case "mov.b32" if o(1).startsWith("%f") => toBits(java.lang.Float.floatToRawIntBits(f(1)))
      case "mov.b32"                          => toBits(r(1))
      case "mov.b64"                          => toWide(d(1))
      case "mov.u64"                          => toWide(0) // The address of own memory.
      case "neg.f32"                          => toFloat(-f(1))
      case "abs.f32"                          => toFloat(math.abs(f(1)))
      case "sqrt.rn.f32"                      => rounded(math.sqrt(f(1)).toFloat)
      case "add.rn.f32"                       => rounded(f(1) + f(2))
      case "sub.rn.f32"                       => rounded(f(1) - f(2))
      case "mul.rn.f32"                       => rounded(f(1) * f(2))
      case "div.rn.f32"                       => rounded(f(1) / f(2))
      case "fma.rn.f32"                       => rounded(Math.fma(f(1), f(2), f(3)))
      case "selp.f32"                         => toFloat(if p(3) then f(1) else f(2))
      case "setp.lt.f32"                      => toCondition(f(1) < f(2))
      case "setp.le.f32"                      => toCondition(f(1) <= f(2))
      case "setp.eq.f32"                      => toCondition(f(1) == f(2))
      case "setp.lt.s32"                      => toCondition(r(1) < r(2))
      case "setp.le.s32"                      => toCondition(r(1) <= r(2))
      case "setp.ge.s32"                      => toCondition(r(1) >= r(2))
      case "setp.eq.s32"                      => toCondition(r(1) == r(2))
      case "and.pred"                         => toCondition(p(1) && p(2))
      case "or.pred"                          => toCondition(p(1) || p(2))
      case "not.pred"                         => toCondition(!p(1))
      case "cvt.rzi.s32.f32"                  => toBits(f(1).toInt)
      case "cvt.u64.u32"                      => toWide(r(1) & 0xffffffffL)
      case "add.s32"                          => toBits(r(1) + r(2))
      case "and.b32"                          => toBits(r(1) & r(2))
      case "or.b32"                           => toBits(r(1) | r(2))
      case "xor.b32"                          => toBits(r(1) ^ r(2))
      case "shl.b32"                          => toBits(r(1) << r(2))
      case "shr.s32"                          => toBits(r(1) >> r(2))
      case "mad.lo.s32"                       => toBits(r(1) * r(2) + r(3))
      case "mul.wide.s32"                     => toWide(r(1).toLong * r(2))
      case "mad.wide.s32"                     => toWide(r(1).toLong * r(2) + d(3))
      case "mad.lo.s64"                       => toWide(d(1) * d(2) + d(3))
      case "add.s64" | "add.u64"              => toWide(d(1) + d(2))
      case "ld.param.u64"     => toWide(arguments(o(1).drop(1).dropRight(1)).asInstanceOf[GpuBuffer].address)
      case "ld.param.u32"     => toBits(arguments(o(1).drop(1).dropRight(1)).asInstanceOf[Int])
      case "ld.param.f32"     => toFloat(arguments(o(1).drop(1).dropRight(1)).asInstanceOf[Float])
      case "ld.global.nc.f32" =>
        val (from, at) = global(1)
        toFloat(from.getFloat(at))
      case "ld.global.nc.u32" =>
        val (from, at) = global(1)
        toBits(from.getInt(at))
      case "ld.global.nc.u64" =>
        val (from, at) = global(1)
        toWide(from.getLong(at))
      case "st.global.f32" =>
        val (to, at) = global(0)
        to.putFloat(at, f(1)): Unit
      case "ld.local.f32" => toFloat(own.getFloat(address(1).toInt))
      case "st.local.f32" => own.putFloat(address(0).toInt, f(1)): Unit
      case other          => sys.error(s"an instruction that is not known: $other")

private object PtxThread:
  private val Address = """\[%rd(\d+)\+(\d+)\]""".r
