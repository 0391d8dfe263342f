package skein.formula

import java.lang.classfile.{ClassFile, ClassModel, Instruction, Label, Opcode}
import java.lang.classfile.instruction.*
import java.lang.constant.ClassDesc
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*

/** The code of a method, with instructions accessible by index.
  *
  * @param source name of the source file
  */
private[formula] final class MethodCode(
    val owner: String,
    val name: String,
    val descriptor: String,
    val isStatic: Boolean,
    source: String,
    val instructions: Array[Instruction],
    lines: Array[Int],
    places: Map[Label, Int],
    val slots: Int
):
  /** Index of the instruction that follows a label. */
  def at(label: Label): Int = places(label)

  def where(instruction: Int): String =
    s"${owner.replace('/', '.')}.$name ($source:${lines(instruction)})"

  /** For each instruction, the first instruction that lies on every path from it to the method's end; the
    * number of instructions stands for the end itself. Paths that end in an exception are ignored.
    */
  lazy val joins: Array[Int] =
    val end          = instructions.length
    val successors   = Array.tabulate(end)(nextOf)
    val predecessors = Array.fill(end + 1)(mutable.ArrayBuffer.empty[Int])
    for i <- 0 until end; next <- successors(i) do predecessors(next) += i
    // Backwards from the end, in the order in which a depth-first walk finishes; −1 if an instruction is not
    // reached.
    val order = mutable.ArrayBuffer.empty[Int]
    val seen  = mutable.BitSet(end)
    val walk  = mutable.Stack((end, 0))
    while walk.nonEmpty do
      val (one, gone) = walk.pop()
      if gone == predecessors(one).size then order += one
      else
        walk.push((one, gone + 1))
        val next = predecessors(one)(gone)
        if seen.add(next) then walk.push((next, 0))
    val rank = Array.fill(end + 1)(-1)
    for i <- order.indices do rank(order(i)) = i
    // Cooper, Harvey, Kennedy: A Simple, Fast Dominance Algorithm (2001), of the reversed graph.
    val joins                     = Array.fill(end + 1)(-1)
    def meet(a: Int, b: Int): Int =
      if a == b then a
      else if rank(a) < rank(b) then meet(joins(a), b)
      else meet(a, joins(b))
    joins(end) = end
    var changes = true
    while changes do
      changes = false
      for i <- order.reverseIterator if i != end do
        val join = successors(i).filter(joins(_) >= 0).reduce(meet)
        if join != joins(i) then
          joins(i) = join
          changes = true
    Array.tabulate(end)(i => if joins(i) < 0 then end else joins(i))

  private def nextOf(i: Int): Seq[Int] = instructions(i) match
    case branch: BranchInstruction =>
      val isGoto = branch.opcode == Opcode.GOTO || branch.opcode == Opcode.GOTO_W
      if isGoto then Seq(at(branch.target)) else Seq(at(branch.target), i + 1)
    case _: ReturnInstruction           => Seq(instructions.length)
    case _: ThrowInstruction            => Nil
    case switch: TableSwitchInstruction =>
      at(switch.defaultTarget) +: switch.cases.asScala.map(each => at(each.target)).toSeq
    case switch: LookupSwitchInstruction =>
      at(switch.defaultTarget) +: switch.cases.asScala.map(each => at(each.target)).toSeq
    case _ => Seq(i + 1)

/** Reads class files through a class loader, each only once. */
private[formula] final class ClassFiles(loader: ClassLoader):
  private val classes = mutable.HashMap.empty[String, Option[ClassModel]]
  private val methods = mutable.HashMap.empty[(String, String, String), Option[MethodCode]]

  private val loaded = mutable.HashMap.empty[String, Class[?]]

  def load(name: String): Class[?] =
    loaded.getOrElseUpdate(name, Class.forName(name.replace('/', '.'), true, loader))

  def classModel(name: String): Option[ClassModel] = classes.getOrElseUpdate(
    name, {
      val file = Option(loader.getResourceAsStream(s"$name.class"))
        .orElse(Option(ClassLoader.getSystemResourceAsStream(s"$name.class")))
      file.map(stream =>
        try ClassFile.of().parse(stream.readAllBytes())
        finally stream.close()
      )
    }
  )

  /** Finds the method that an object of this class has: that of the class, of a superclass, or of an
    * interface.
    *
    * @return None if the method has no code
    */
  def method(className: String, name: String, descriptor: String): Option[MethodCode] =
    methods.getOrElseUpdate((className, name, descriptor), inClasses(className, name, descriptor))

  /** All superclasses of a class, and all interfaces of these and of the class. */
  def ancestors(className: String): Vector[String] =
    classModel(className).toVector.flatMap: model =>
      val above =
        model.superclass.toScala.map(_.asInternalName).toVector ++ model.interfaces.asScala.map(
          _.asInternalName
        )
      above ++ above.flatMap(ancestors)

  private def inClasses(className: String, name: String, descriptor: String): Option[MethodCode] =
    def supers(of: String): LazyList[String] =
      of #:: classModel(of).flatMap(_.superclass.toScala).map(_.asInternalName).to(LazyList).flatMap(supers)
    val all = supers(className).toVector
    (all.iterator ++ all.iterator.flatMap(ancestors)).flatMap(declared(_, name, descriptor)).nextOption()

  private def declared(className: String, name: String, descriptor: String): Option[MethodCode] =
    for
      model  <- classModel(className)
      method <- model.methods.asScala.find(each =>
        each.methodName.equalsString(name) && each.methodType.equalsString(descriptor)
      )
      code <- method.code.toScala
    yield
      val instructions = mutable.ArrayBuffer.empty[Instruction]
      val lines        = mutable.ArrayBuffer.empty[Int]
      val places       = mutable.HashMap.empty[Label, Int]
      var line         = 0
      code.forEach:
        case label: LabelTarget       => places(label.label) = instructions.size
        case number: LineNumber       => line = number.line
        case instruction: Instruction =>
          instructions += instruction
          lines += line
        case _ => ()
      val source = model
        .findAttribute(java.lang.classfile.Attributes.sourceFile())
        .toScala
        .fold(className)(_.sourceFile.stringValue)
      MethodCode(
        className,
        name,
        descriptor,
        method.flags.has(java.lang.reflect.AccessFlag.STATIC),
        source,
        instructions.toArray,
        lines.toArray,
        places.toMap,
        code.asInstanceOf[java.lang.classfile.attribute.CodeAttribute].maxLocals
      )

private[formula] object ClassFiles:
  def isLibrary(owner: String): Boolean =
    owner.startsWith("scala/") || owner.startsWith("java/") || owner.startsWith("jdk/")

  def nameOf(of: Class[?]): String = of.getName.replace('.', '/')

  def internalName(of: ClassDesc): String =
    if of.isClassOrInterface then of.descriptorString.substring(1, of.descriptorString.length - 1)
    else of.descriptorString
