package skein.gpu

import java.util.HexFormat

/** Generates the text of one kernel in PTX, the instructions that NVIDIA's driver translates for the GPU of
  * the machine (PTX ISA 6.4). Each operation takes registers by number and returns its result in a new
  * register, unless it assigns a variable. Floats are rounded to nearest and never flushed to zero or
  * implicitly fused, so that they equal a CPU's to the bit. Mutable.
  *
  * @param parameters the kernel's parameters, each with its name
  * @param localBytes size of each thread's own memory
  */
final class Ptx(name: String, parameters: Seq[(String, Ptx.Kind)], localBytes: Int = 0):
  import Ptx.*

  private val text      = StringBuilder()
  private var registers = 0
  private var labels    = 0

  def fresh(): Int =
    registers += 1
    registers - 1

  def label(): String =
    labels += 1
    s"L$labels"

  def place(label: String): Unit = text.append(label).append(":\n"): Unit

  def apply(instruction: String): Unit = text.append('\t').append(instruction).append(";\n"): Unit

  // Floats.

  def constant(value: Float, into: Int = fresh()): Int =
    result(into)(r => s"mov.f32 %f$r, 0f${hex(java.lang.Float.floatToRawIntBits(value))}")
  def move(from: Int, into: Int): Unit            = this(s"mov.f32 %f$into, %f$from")
  def one(operation: String, a: Int): Int         = result()(r => s"$operation.f32 %f$r, %f$a")
  def two(operation: String, a: Int, b: Int): Int = result()(r => s"$operation.f32 %f$r, %f$a, %f$b")
  def fma(a: Int, b: Int, c: Int): Int            = result()(r => s"fma.rn.f32 %f$r, %f$a, %f$b, %f$c")
  def choose(condition: Int, a: Int, b: Int): Int = result()(r => s"selp.f32 %f$r, %f$a, %f$b, %p$condition")
  def compare(how: String, a: Int, b: Int): Int   = result()(r => s"setp.$how.f32 %p$r, %f$a, %f$b")

  def wholeOf(a: Int): Int = result()(r => s"cvt.rzi.s32.f32 %r$r, %f$a")

  // Conditions.

  def conditions(how: String, a: Int, b: Int): Int = result()(r => s"$how.pred %p$r, %p$a, %p$b")
  def not(a: Int): Int                             = result()(r => s"not.pred %p$r, %p$a")

  // Integers and bits.

  def whole(value: Int, into: Int = fresh()): Int     = result(into)(r => s"mov.b32 %r$r, $value")
  def wholes(how: String, a: Int, b: Int): Int        = result()(r => s"$how %r$r, %r$a, %r$b")
  def wholes(how: String, a: Int, b: String): Int     = result()(r => s"$how %r$r, %r$a, $b")
  def compareWholes(how: String, a: Int, b: Int): Int = result()(r => s"setp.$how.s32 %p$r, %r$a, %r$b")
  def compareWhole(how: String, a: Int, b: Int): Int  = result()(r => s"setp.$how.s32 %p$r, %r$a, $b")
  def bitsOf(a: Int): Int                             = result()(r => s"mov.b32 %r$r, %f$a")
  def ofBits(a: Int): Int                             = result()(r => s"mov.b32 %f$r, %r$a")
  def special(register: String): Int                  = result()(r => s"mov.u32 %r$r, %$register")

  def thread(): Int =
    val (block, size, own) = (special("ctaid.x"), special("ntid.x"), special("tid.x"))
    result()(r => s"mad.lo.s32 %r$r, %r$block, %r$size, %r$own")

  // Addresses.

  /** Address of an element of an array whose elements have this number of 4-byte words. */
  def address(base: Int, index: Int, words: Int = 1): Int =
    result()(r => s"mad.wide.s32 %rd$r, %r$index, ${4 * words}, %rd$base")

  /** Product of an integer and a factor, as wide as an address. */
  def wide(a: Int, factor: Int): Int = result()(r => s"mul.wide.s32 %rd$r, %r$a, $factor")
  def sum(a: Int, b: Int): Int       = result()(r => s"add.s64 %rd$r, %rd$a, %rd$b")

  /** `base + index * stride` bytes, as an address. */
  def advanced(from: Int, times: Int, bytes: Int): Int =
    val wide = result()(r => s"cvt.u64.u32 %rd$r, %r$times")
    result()(r => s"mad.lo.s64 %rd$r, %rd$wide, %rd$bytes, %rd$from")

  def argument(parameter: String): Int = parameters.collectFirst {
    case (`parameter`, Kind.Address) => result()(r => s"ld.param.u64 %rd$r, [$parameter]")
    case (`parameter`, Kind.Whole)   => result()(r => s"ld.param.u32 %r$r, [$parameter]")
  }.getOrElse(throw new NoSuchElementException(s"$name has no parameter $parameter"))

  def load(base: Int, word: Int = 0, into: Int = fresh()): Int =
    result(into)(r => s"ld.global.nc.f32 %f$r, [%rd$base+${4 * word}]")
  def loadWhole(base: Int, word: Int = 0, into: Int = fresh()): Int =
    result(into)(r => s"ld.global.nc.u32 %r$r, [%rd$base+${4 * word}]")
  def loadAddress(base: Int, word: Int): Int =
    result()(r => s"ld.global.nc.u64 %rd$r, [%rd$base+${4 * word}]")
  def store(value: Int, base: Int, word: Int = 0): Unit =
    this(s"st.global.f32 [%rd$base+${4 * word}], %f$value")

  // The thread's own memory, at offsets in bytes.

  def own(bytes: Int): Int =
    val wide = result()(r => s"cvt.u64.u32 %rd$r, %r$bytes")
    result()(r => s"add.u64 %rd$r, %rd$wide, %rd${ownBase()}")

  private var base = None: Option[Int]

  /** Address of the thread's own memory; must be called before the first branch. */
  def ownBase(): Int =
    if base.isEmpty then base = Some(result()(r => s"mov.u64 %rd$r, own"))
    base.get

  def loadOwn(at: Int, word: Int): Int = result()(r => s"ld.local.f32 %f$r, [%rd$at+${4 * word}]")
  def storeOwn(value: Int, at: Int, word: Int): Unit = this(s"st.local.f32 [%rd$at+${4 * word}], %f$value")

  // Branches.

  def go(to: String): Unit                                          = this(s"bra.uni $to")
  def goIf(condition: Int, to: String, holds: Boolean = true): Unit =
    this(s"@${if holds then "" else "!"}%p$condition bra $to")

  /** Jumps to the label with this number, which must be equal in all threads of a block. */
  def goTo(number: Int, labels: Seq[String]): Unit =
    val table = label()
    text.append(s"$table:\t.branchtargets ${labels.mkString(", ")};\n")
    this(s"brx.idx.uni %r$number, $table")

  /** Repeats the code that `body` generates as often as the register `times` says. */
  def repeat(times: Int)(body: => Unit): Unit =
    val (again, over) = (label(), label())
    val left          = wholes("add.s32", times, "0")
    place(again)
    goIf(compareWhole("le", left, 0), over)
    body
    this(s"add.s32 %r$left, %r$left, -1")
    go(again)
    place(over)

  private def result(into: Int = fresh())(instruction: Int => String): Int =
    this(instruction(into))
    into

  def module: String =
    val arguments = parameters.map((name, kind) => s"\t${kind.declared(name)}").mkString(",\n")
    val own       = if localBytes > 0 then s"\t.local .align 16 .b8 own[$localBytes];\n" else ""
    val declared  = Seq("f32 %f", "pred %p", "b32 %r", "b64 %rd")
      .map(kind => s"\t.reg .$kind<${registers + 1}>;\n")
      .mkString
    s".version 6.4\n.target sm_75\n.address_size 64\n\n.visible .entry $name(\n$arguments\n)\n{\n$declared$own$text}\n"

  private def hex(bits: Int) = HexFormat.of.withUpperCase.toHexDigits(bits)

object Ptx:
  enum Kind:
    case Address, Whole

    private[gpu] def declared(name: String): String = this match
      case Address => s".param .u64 $name"
      case Whole   => s".param .u32 $name"
