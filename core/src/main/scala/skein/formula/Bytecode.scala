package skein.formula

import java.lang.classfile.{ClassFile, ClassModel, Instruction, Label, Opcode}
import java.lang.classfile.instruction.*
import java.lang.constant.ClassDesc
import scala.collection.mutable
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*

/** A method's code, by the number of the instruction.
  *
  * @param source
  *   the file it was written in
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
  /** The instruction that a label stands before. */
  def at(label: Label): Int = places(label)

  def where(instruction: Int): String =
    s"${owner.replace('/', '.')}.$name ($source:${lines(instruction)})"

  /** For each instruction the first that every way from it to the method's end goes through; the number of instructions
    * for the end itself. Ways that end by throwing are left out.
    */
  lazy val joins: Array[Int] =
    val end          = instructions.length
    val successors   = Array.tabulate(end)(nextOf)
    val after        = Array.fill(end + 1)(mutable.BitSet.empty)
    val predecessors = Array.fill(end + 1)(mutable.ArrayBuffer.empty[Int])
    for i <- 0 until end; next <- successors(i) do predecessors(next) += i
    // Those from which the end can be reached.
    val returns            = mutable.BitSet.empty
    def mark(i: Int): Unit =
      val waiting = mutable.Stack(i)
      while waiting.nonEmpty do
        val one = waiting.pop()
        if returns.add(one) then waiting.pushAll(predecessors(one))
    mark(end)
    val everything = mutable.BitSet.fromSpecific(returns)
    for i <- 0 to end do after(i) = if i == end then mutable.BitSet(end) else everything.clone
    var changes = true
    while changes do
      changes = false
      for i <- (0 until end).reverse if returns(i) do
        val ways = successors(i).filter(returns)
        val both = ways.map(after(_)).reduce((a, b) => a & b).clone
        both += i
        if both != after(i) then
          after(i) = both
          changes = true
    Array.tabulate(end): i =>
      if !returns(i) then end else after(i).iterator.filter(_ != i).maxBy(next => after(next).size)

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

/** Class files as a loader finds them, each read once. */
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

  /** The method as an object of this class has it: its own, a superclass's, or an interface's.
    *
    * @return
    *   none where it has no code
    */
  def method(className: String, name: String, descriptor: String): Option[MethodCode] =
    methods.getOrElseUpdate((className, name, descriptor), inClasses(className, name, descriptor))

  /** Every interface of a class and of its superclasses, and these. */
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
