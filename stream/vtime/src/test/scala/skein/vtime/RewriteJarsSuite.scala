package skein.vtime

import java.lang.classfile.ClassFile
import java.lang.classfile.instruction.{InvokeDynamicInstruction, InvokeInstruction}
import java.net.URLClassLoader
import java.nio.file.{Files, Path}
import java.util.zip.{ZipEntry, ZipFile, ZipOutputStream}
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import scala.util.Using
import skein.testing.TemporaryFolders
import skein.vtime.agent.{Agent, RewriteJars}

class RewriteJarsSuite extends munit.FunSuite, TemporaryFolders:
  private val deadline = "scala/concurrent/duration/Deadline$.class"
  private val some     = "scala/Some.class"

  private def bytesOf(name: String): Array[Byte] =
    Using.resource(classOf[Option[?]].getClassLoader.getResourceAsStream(name))(_.readAllBytes())

  private def jar(file: Path, names: String*): Path =
    Using.resource(ZipOutputStream(Files.newOutputStream(file))): out =>
      for name <- names do
        out.putNextEntry(ZipEntry(name))
        out.write(bytesOf(name))
    file

  private def entry(jar: Path, name: String): Array[Byte] =
    Using.resource(ZipFile(jar.toFile))(zip => zip.getInputStream(zip.getEntry(name)).readAllBytes())

  private def calls(bytes: Array[Byte]): Set[String] =
    val methods = ClassFile.of().parse(bytes).methods.asScala.toSet
    for
      method  <- methods
      element <- method.code.toScala.toSet.flatMap(_.elementList.asScala)
      called  <- element match
        case call: InvokeInstruction => Some(s"${call.owner.asInternalName}.${call.name.stringValue}")
        case _                       => None
    yield called

  test("rewritten jars read virtual time without an agent, and their other classes are unchanged"):
    val folder = temporaryFolder()
    val scala  = jar(folder.resolve("scala.jar"), deadline, some)
    val agent  = jar(folder.resolve("agent.jar"), s"${classOf[Agent].getName.replace('.', '/')}.class")
    val other  = jar(folder.resolve("other.jar"), some)
    val before = Files.readAllBytes(other)
    RewriteJars.main(folder.toString)
    assert(calls(bytesOf(deadline)).contains("java/lang/System.nanoTime"))
    assert(!clue(calls(entry(scala, deadline))).contains("java/lang/System.nanoTime"))
    assert(calls(entry(scala, deadline)).contains("skein/vtime/agent/Redirect.nanoTime"))
    assertEquals(entry(scala, some).toSeq, bytesOf(some).toSeq)
    assert(entry(agent, "skein/vtime/agent/Draws.class").nonEmpty)
    assertEquals(Files.readAllBytes(other).toSeq, before.toSeq)
    assertEquals(Files.list(folder).toList.size, 3)

  test("lambdas of rewritten jars are linked in a way that an ahead-of-time cache can store"):
    val name    = s"${classOf[Lambdas].getName.replace('.', '/')}.class"
    val folder  = temporaryFolder()
    val classes = jar(folder.resolve("classes.jar"), name)
    assertEquals(factories(bytesOf(name)), Set("altMetafactory", "metafactory"))
    RewriteJars.main(folder.toString)
    assertEquals(factories(entry(classes, name)), Set("metafactory"))
    val loader = new URLClassLoader(Array(classes.toUri.toURL), getClass.getClassLoader):
      override def loadClass(wanted: String, resolves: Boolean): Class[?] =
        if wanted == classOf[Lambdas].getName then
          Option(findLoadedClass(wanted)).getOrElse(findClass(wanted))
        else super.loadClass(wanted, resolves)
    val made = loader.loadClass(classOf[Lambdas].getName).getConstructor().newInstance()
    assert(made.getClass != classOf[Lambdas])
    val results = made.asInstanceOf[() => Seq[String]]()
    assertEquals(results, Lambdas()())

  /** How the lambdas of a class are linked. */
  private def factories(bytes: Array[Byte]): Set[String] =
    val calls =
      for
        method <- ClassFile.of().parse(bytes).methods.asScala.toSet
        if !method.methodName.equalsString("$deserializeLambda$")
        element <- method.code.toScala.toSet.flatMap(_.elementList.asScala)
        called  <- element match
          case call: InvokeDynamicInstruction => Some(call.bootstrapMethod.methodName)
          case _                              => None
      yield called
    calls.filter(_.endsWith("etafactory"))

/** Lambdas of generic, primitive and Java's types, that capture and that do not. */
final class Lambdas extends (() => Seq[String]):
  def apply(): Seq[String] =
    val word             = "word"
    val lengths          = Seq("one", "three").map(_.length + word.length)
    val halves           = lengths.map(_ * 0.5)
    val runs             = StringBuilder()
    val task             = new Runnable { def run(): Unit = runs.append(word): Unit }
    val lambda: Runnable = () => runs.append("ran"): Unit
    task.run()
    lambda.run()
    Seq(lengths, halves, runs.toString, Option(word).filter(_.nonEmpty).fold(0)(_.length)).map(_.toString)
