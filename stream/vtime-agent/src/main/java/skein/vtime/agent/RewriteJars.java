package skein.vtime.agent;

import java.io.IOException;
import java.net.MalformedURLException;
import java.net.URL;
import java.net.URLClassLoader;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import java.util.List;
import java.util.stream.Stream;
import java.util.zip.ZipEntry;
import java.util.zip.ZipFile;
import java.util.zip.ZipInputStream;
import java.util.zip.ZipOutputStream;

/**
 * Rewrites the jars of a program once, in place, as {@link Agent} would at run time: such a program needs no
 * agent, which would prevent a JVM from using an ahead-of-time cache.
 */
public final class RewriteJars {
  private static final String AGENT = "skein/vtime/agent/Agent.class";
  private static final String DRAWS = "skein/vtime/agent/Draws.class";

  private RewriteJars() {}

  /**
   * Runs the rewriting.
   *
   * @param folder all jars of the program, including this one, which receives a class
   */
  public static void main(String... folder) throws IOException {
    List<Path> jars;
    try (Stream<Path> files = Files.list(Path.of(folder[0]))) {
      jars = files.filter(file -> file.toString().endsWith(".jar")).sorted().toList();
    }
    // Stack map frames are recomputed, which needs the class hierarchy.
    try (var classes = new URLClassLoader(jars.stream().map(RewriteJars::url).toArray(URL[]::new))) {
      var rewriter = new Rewriter(Rewriter.PACKAGES, RewriteJars::fail);
      for (var jar : jars) if (holdsAny(jar)) rewrite(jar, rewriter, classes);
    }
  }

  private static boolean holdsAny(Path jar) throws IOException {
    try (var zip = new ZipFile(jar.toFile())) {
      return zip.stream()
          .map(ZipEntry::getName)
          .anyMatch(name -> name.equals(AGENT) || Rewriter.PACKAGES.stream().anyMatch(name::startsWith));
    }
  }

  private static void rewrite(Path jar, Rewriter rewriter, ClassLoader classes) throws IOException {
    var rewritten = jar.resolveSibling(jar.getFileName() + ".rewritten");
    try (var in = new ZipInputStream(Files.newInputStream(jar));
        var out = new ZipOutputStream(Files.newOutputStream(rewritten))) {
      for (var entry = in.getNextEntry(); entry != null; entry = in.getNextEntry()) {
        var name = entry.getName();
        var bytes = in.readAllBytes();
        if (name.endsWith(".class")) {
          var better = rewriter.transform(classes, name.substring(0, name.length() - 6), null, null, bytes);
          if (better != null) bytes = better;
        }
        write(out, name, entry.getTime(), bytes);
        if (name.equals(AGENT)) write(out, DRAWS, entry.getTime(), Rewriter.DRAWS_CLASS);
      }
    }
    Files.move(rewritten, jar, StandardCopyOption.REPLACE_EXISTING);
  }

  private static void write(ZipOutputStream out, String name, long time, byte[] bytes) throws IOException {
    var entry = new ZipEntry(name);
    entry.setTime(time);
    out.putNextEntry(entry);
    out.write(bytes);
    out.closeEntry();
  }

  private static URL url(Path jar) {
    try {
      return jar.toUri().toURL();
    } catch (MalformedURLException impossible) {
      throw new AssertionError(impossible);
    }
  }

  private static void fail(String className, Throwable cause) {
    throw new IllegalStateException("cannot rewrite " + className, cause);
  }
}
