package skein.vtime

import java.lang.classfile.ClassFile
import java.lang.classfile.instruction.InvokeInstruction
import java.nio.file.{Files, Path}
import java.util.zip.{ZipEntry, ZipFile, ZipOutputStream}
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import scala.util.Using
import skein.testing.TemporaryFolders
import skein.vtime.agent.{Agent, RewriteJars}

class RewriteJarsSuite extends munit.FunSuite, TemporaryFolders:
  private val deadline = "scala/concurrent/duration/Deadline$.class"
  private val option   = "scala/Option.class"

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
    val scala  = jar(folder.resolve("scala.jar"), deadline, option)
    val agent  = jar(folder.resolve("agent.jar"), s"${classOf[Agent].getName.replace('.', '/')}.class")
    val other  = jar(folder.resolve("other.jar"), option)
    val before = Files.readAllBytes(other)
    RewriteJars.main(folder.toString)
    assert(calls(bytesOf(deadline)).contains("java/lang/System.nanoTime"))
    assert(!clue(calls(entry(scala, deadline))).contains("java/lang/System.nanoTime"))
    assert(calls(entry(scala, deadline)).contains("skein/vtime/agent/Redirect.nanoTime"))
    assertEquals(entry(scala, option).toSeq, bytesOf(option).toSeq)
    assert(entry(agent, "skein/vtime/agent/Draws.class").nonEmpty)
    assertEquals(Files.readAllBytes(other).toSeq, before.toSeq)
    assertEquals(Files.list(folder).toList.size, 3)
