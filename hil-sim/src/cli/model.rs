//! `hil-sim model`: the contact model at chosen times, as CSV.

use std::io::{self, Write};

use anyhow::{Context, anyhow, ensure};
use clap::{Args, ValueEnum};
use contact_model::fixed_point::{Celsius, ContactPair, Log2, TEMPERATURE_RANGE_C};
use contact_model::material::{
    DESCRIPTIONS, MATERIALS, Material, REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA, Surface,
    find,
};
use contact_model::pressure::pressure_pa;
use contact_model::reference::{Contact, Real};
use thermal_sim::scene::known_materials;

use super::Failure;

#[derive(Args)]
#[command(after_help = materials())]
pub struct Arguments {
    /// Name of a material, from the list below
    #[arg(long, required_unless_present = "k_w_mk", conflicts_with = "k_w_mk")]
    material: Option<String>,
    /// Conductivity of an own material, W/(m K)
    #[arg(long, requires_all = ["rho_kg_m3", "c_j_kgk", "rq_um", "slope_rad"])]
    k_w_mk: Option<f64>,
    /// Its density, kg/m³
    #[arg(long, requires = "k_w_mk")]
    rho_kg_m3: Option<f64>,
    /// Its specific heat, J/(kg K)
    #[arg(long, requires = "k_w_mk")]
    c_j_kgk: Option<f64>,
    /// Its RMS roughness, µm
    #[arg(long, requires = "k_w_mk")]
    rq_um: Option<f64>,
    /// Its mean asperity slope, rad
    #[arg(long, requires = "k_w_mk")]
    slope_rad: Option<f64>,
    /// Contact force, N; area follows by the thesis's five points
    #[arg(
        long,
        default_value_t = 2.0,
        conflicts_with = "pressure_pa",
        allow_negative_numbers = true
    )]
    force_n: f64,
    /// Contact pressure instead of force, Pa
    #[arg(long, allow_negative_numbers = true)]
    pressure_pa: Option<f64>,
    /// Skin before contact, °C
    #[arg(long, default_value_t = 34.0, allow_negative_numbers = true)]
    skin_c: f64,
    /// Object before contact, °C
    #[arg(long, default_value_t = 24.0, allow_negative_numbers = true)]
    object_c: f64,
    /// Times since landing, s
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "0,0.01,0.1,1,10",
        allow_negative_numbers = true
    )]
    times: Vec<f64>,
    /// Give the skin's temperature at this depth, m, instead of its surface's (f64 only)
    #[arg(long, allow_negative_numbers = true)]
    depth_m: Option<f64>,
    /// Arithmetic; fixed is the firmware's own
    #[arg(long, value_enum, default_value_t = Arithmetic::Fixed)]
    arith: Arithmetic,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Arithmetic {
    Fixed,
    F32,
    F64,
}

/// A row of the output, as numbers.
struct ModelRow {
    z: f64,
    erfcx: f64,
    t_skin_c: f64,
    t_object_c: f64,
    q_w_m2: f64,
    t_display_c: f64,
    r_m2k_w: f64,
    ratio: f64,
}

/// Prints the table.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (object, pressure_pa) = check(arguments).map_err(Failure::input)?;
    let rows: Vec<ModelRow> = (arguments.times.iter())
        .map(|&t_s| match arguments.arith {
            Arithmetic::Fixed => fixed(arguments, &object, pressure_pa, t_s),
            Arithmetic::F32 => Ok(float::<f32>(arguments, &object, pressure_pa, t_s)),
            Arithmetic::F64 => Ok(float::<f64>(arguments, &object, pressure_pa, t_s)),
        })
        .collect::<Result<_, _>>()
        .map_err(Failure::input)?;
    for (t_s, row) in arguments.times.iter().zip(&rows) {
        if let Some((column, value)) = row.columns().into_iter().find(|(_, x)| !x.is_finite()) {
            return Err(Failure::input(anyhow!(
                "--times {t_s:?}: {column} is {value} of this material and load; allowed are those with which every column is finite"
            )));
        }
    }
    print(&arguments.times, &rows).map_err(Failure::run)
}

impl ModelRow {
    /// Names and values of the columns behind the time, in their order.
    const fn columns(&self) -> [(&'static str, f64); 8] {
        let Self { z, erfcx, t_skin_c, t_object_c, q_w_m2, t_display_c, r_m2k_w, ratio } = *self;
        [
            ("z", z),
            ("erfcx", erfcx),
            ("t_skin_c", t_skin_c),
            ("t_object_c", t_object_c),
            ("q_w_m2", q_w_m2),
            ("t_display_c", t_display_c),
            ("r_m2k_w", r_m2k_w),
            ("ratio", ratio),
        ]
    }
}

fn print(times: &[f64], rows: &[ModelRow]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "t_s,z,erfcx,t_skin_c,t_object_c,q_w_m2,t_display_c,r_m2k_w,ratio")?;
    for (t_s, row) in times.iter().zip(rows) {
        let cells = row.columns().map(|(_, value)| value.to_string());
        writeln!(out, "{t_s},{}", cells.join(","))?;
    }
    Ok(())
}

/// All materials with their descriptions.
fn materials() -> String {
    let rows = MATERIALS.iter().zip(DESCRIPTIONS);
    let lines = rows.map(|((name, _), description)| format!("\n  {name:15}  {description}"));
    "Materials:".to_owned() + &lines.collect::<String>()
}

/// The material and the pressure in Pa, if everything is in range.
fn check(arguments: &Arguments) -> anyhow::Result<(Material, f64)> {
    let object = match &arguments.material {
        Some(name) => *find(name)
            .ok_or_else(|| anyhow!("--material {name}; known are {}", known_materials()))?,
        None => {
            let given = |name, value: Option<f64>| {
                let value = value.with_context(|| format!("{name} is missing"))?;
                ensure!(
                    value > 0.0 && value.is_finite(),
                    "{name} {value}; allowed is a finite number above 0"
                );
                Ok(value)
            };
            Material {
                surface: Surface {
                    conductivity_w_mk: given("--k-w-mk", arguments.k_w_mk)?,
                    roughness_um: given("--rq-um", arguments.rq_um)?,
                    slope_rad: given("--slope-rad", arguments.slope_rad)?,
                },
                density_kg_m3: given("--rho-kg-m3", arguments.rho_kg_m3)?,
                specific_heat_j_kgk: given("--c-j-kgk", arguments.c_j_kgk)?,
            }
        }
    };
    let (name, load) = match arguments.pressure_pa {
        Some(pressure_pa) => ("--pressure-pa", pressure_pa),
        None => ("--force-n", arguments.force_n),
    };
    ensure!(load > 0.0 && load.is_finite(), "{name} {load}; allowed is a finite number above 0");
    let (least, most) = TEMPERATURE_RANGE_C.into_inner();
    for (name, t_c) in [("--skin-c", arguments.skin_c), ("--object-c", arguments.object_c)] {
        let range = f64::from(least)..=f64::from(most);
        ensure!(range.contains(&t_c), "{name} {t_c}; allowed is {least} to {most}");
    }
    for t_s in &arguments.times {
        ensure!(
            *t_s >= 0.0 && t_s.is_finite(),
            "--times {t_s}; allowed is a finite number from 0 on"
        );
    }
    if let Some(depth_m) = arguments.depth_m {
        ensure!(
            depth_m >= 0.0 && depth_m.is_finite(),
            "--depth-m {depth_m}; allowed is a finite number from 0 on"
        );
        ensure!(arguments.arith == Arithmetic::F64, "--depth-m needs --arith f64");
    }
    Ok((object, arguments.pressure_pa.unwrap_or_else(|| pressure_pa(arguments.force_n))))
}

/// The fixed-point path of the firmware: one tick of `b² t`.
fn fixed(
    arguments: &Arguments,
    object: &Material,
    pressure_pa: f64,
    t_s: f64,
) -> anyhow::Result<ModelRow> {
    let (elapsed, tick_s) = if t_s == 0.0 { (0, 1.0) } else { (1, t_s) };
    let relative = (pressure_pa / SKIN_MICROHARDNESS_PA).log2();
    let contact = ContactPair::new(&SKIN, object, &REFERENCE_DISPLAY, tick_s)?
        .at_pressure(Log2::saturating_from_num(relative));
    let (skin, object) =
        (Celsius::from_num(arguments.skin_c), Celsius::from_num(arguments.object_c));
    let at = contact.at(elapsed, skin, object);
    Ok(ModelRow {
        z: if elapsed == 0 { 0.0 } else { contact.rate_per_tick.to_f64().sqrt() },
        erfcx: at.erfcx().to_num(),
        t_skin_c: at.skin().to_num(),
        t_object_c: at.object().to_num(),
        q_w_m2: at.flux_w_m2().to_num(),
        t_display_c: at.display().to_num(),
        r_m2k_w: 1.0 / contact.conductance_w_m2k.to_f64(),
        ratio: contact.ratio.to_num(),
    })
}

fn float<F: Real>(
    arguments: &Arguments,
    object: &Material,
    pressure_pa: f64,
    t_s: f64,
) -> ModelRow {
    let f = F::from_f64;
    let finger = (&SKIN, f(arguments.skin_c));
    let contact =
        Contact::new(finger, (object, f(arguments.object_c)), &REFERENCE_DISPLAY, f(pressure_pa));
    let at = contact.at(f(t_s));
    let depth_m = arguments.depth_m.map(f);
    let skin_c = depth_m.map_or(at.skin_c, |depth_m| contact.skin_at_depth(&SKIN, depth_m, f(t_s)));
    ModelRow {
        z: (contact.rate_per_s * f(t_s)).sqrt().to_f64(),
        erfcx: at.erfcx.to_f64(),
        t_skin_c: skin_c.to_f64(),
        t_object_c: at.object_c.to_f64(),
        q_w_m2: at.flux_w_m2.to_f64(),
        t_display_c: at.display_c.to_f64(),
        r_m2k_w: contact.resistance_m2k_w.to_f64(),
        ratio: contact.ratio.to_f64(),
    }
}
