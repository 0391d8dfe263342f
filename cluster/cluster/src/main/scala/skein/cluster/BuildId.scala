package skein.cluster

import java.io.File
import java.nio.file.{Files, Path}
import java.security.MessageDigest
import java.util.HexFormat
import java.util.zip.{CRC32, ZipFile}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** Identifies the code that a process would compute with: the classes on its class path, wherever they are.
  */
object BuildId:

  /** 16 hexadecimal digits. Processes with equal digits have equal classes; any additional class, such as a
    * user's scenario, changes them.
    */
  lazy val current: String = of(
    sys.props("java.class.path").split(File.pathSeparatorChar).toVector.filter(_.nonEmpty).map(Path.of(_))
  )

  private[cluster] def of(classPath: Vector[Path]): String =
    val classes = classPath.flatMap(part =>
      if Files.isDirectory(part) then ofFolder(part)
      else if Files.isRegularFile(part) then ofJar(part)
      else Vector.empty
    )
    val digest = MessageDigest.getInstance("SHA-256")
    for (name, crc) <- classes.distinct.sorted do digest.update(s"$name $crc\n".getBytes("UTF-8"))
    HexFormat.of.formatHex(digest.digest(), 0, 8)

  private def isClass(name: String) = name.endsWith(".class")

  /** Checksums from the archive's directory; nothing is unpacked. */
  private def ofJar(jar: Path): Vector[(String, Long)] =
    Using.resource(ZipFile(jar.toFile)): archive =>
      archive.entries.asScala.filter(entry => isClass(entry.getName)).map(entry =>
        (entry.getName, entry.getCrc)
      ).toVector

  private def ofFolder(folder: Path): Vector[(String, Long)] =
    Using.resource(Files.walk(folder)): files =>
      files.iterator.asScala.filter(file => isClass(file.getFileName.toString)).map: file =>
        val crc = CRC32()
        crc.update(Files.readAllBytes(file))
        (folder.relativize(file).toString.replace(File.separatorChar, '/'), crc.getValue)
      .toVector
